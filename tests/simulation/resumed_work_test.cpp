// Response maps and fits that were stopped and resumed have the bits of those that were not.
#include <doctest/doctest.h>

#include <fstream>

#include "scenes.hpp"
#include "scintray/simulation/fit.hpp"
#include "scintray/simulation/response.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

void check_same(const ResponseMap& a, const ResponseMap& b) {
  CHECK(a.channels == b.channels);
  REQUIRE(a.grids.size() == b.grids.size());
  for (std::size_t i = 0; i < a.grids.size(); ++i) {
    CHECK(a.grids[i].photons == b.grids[i].photons);
    CHECK(a.grids[i].detected == b.grids[i].detected);
    CHECK(a.grids[i].probabilities == b.grids[i].probabilities);
    CHECK(a.grids[i].probability_errors == b.grids[i].probability_errors);
    CHECK(a.grids[i].delays_ns == b.grids[i].delays_ns);
  }
}

/// A crystal with a painted side, the reflectance of which is fitted.
std::string fitted_scene(const std::filesystem::path& csv) {
  return painted_crystal(0.9) + R"(
[source]
type = "photons"
region = { part = "crystal", slab_z = ["1 mm", "1.2 mm"] }
wavelength = "420 nm"
photons = 1000
[fit]
measurement = ")" +
         csv.string() + R"("
quantity = "detected_fraction"
at = "source.region.slab_z.center"
unit = "mm"
scale = "free"
[[fit.parameter]]
key = "surfaces.paint.reflectance"
start = 0.8
low = 0.5
high = 0.99
)";
}

}  // namespace

TEST_CASE("A response map that was stopped again and again is the one of an uninterrupted process") {
  const scene_file::SceneFile scene = scene_of(kCrystal + kEvents);
  MapOptions options;
  options.settings = {1.0, 200, 5};
  options.simulation.threads = 3;
  const ResponseFile whole = build_map(scene, options);
  REQUIRE(whole.map.grids.size() == 1);
  const auto path = scratch_folder("resumed_map") / "m.h5.journal";
  options.journal = JournalSettings{path, JournalStart::resume};
  options.simulation.threads = 1;  // threads that are fast would finish before they see the stop
  ResponseFile resumed;
  int stops = 0;
  for (; resumed.map.grids.empty(); ++stops) {
    REQUIRE(stops < 30);
    std::atomic<bool> stop{false};
    std::uint64_t first = 0;
    options.hooks.stop = &stop;
    options.hooks.progress = [&](std::uint64_t cells, std::uint64_t) {
      if (first == 0) first = cells;
      if (cells >= static_cast<std::uint64_t>(4 * (stops + 1))) stop = true;
    };
    resumed = build_map(scene, options);
  }
  CHECK(stops > 2);
  check_same(whole.map, resumed.map);
  // Other photons, or another scene, are other work.
  options.hooks = {};
  options.settings.photons_per_cell = 201;
  check_contains(complaint_of([&] { build_map(scene, options); }), {"m.h5.journal", "other work"});
  options.settings.photons_per_cell = 200;
  options.journal->start = JournalStart::refuse;
  check_contains(complaint_of([&] { build_map(scene, options); }), "--resume");
}

TEST_CASE("A response map traced backward that was stopped again and again is the same one") {
  const scene_file::SceneFile scene = scene_of(kCrystal + kEvents);
  MapOptions options;
  options.settings = {1.0, 200, 5, MapDirection::backward, 4000};
  options.simulation.threads = 3;
  const ResponseFile whole = build_map(scene, options);
  REQUIRE(whole.map.backward());
  REQUIRE(whole.map.grids.size() == 1);
  const auto path = scratch_folder("resumed_backward_map") / "m.h5.journal";
  options.journal = JournalSettings{path, JournalStart::resume};
  options.simulation.threads = 1;
  ResponseFile resumed;
  int stops = 0;
  for (; resumed.map.grids.empty(); ++stops) {
    REQUIRE(stops < 30);
    std::atomic<bool> stop{false};
    options.hooks.stop = &stop;
    options.hooks.progress = [&](std::uint64_t photons, std::uint64_t) {
      stop = photons >= static_cast<std::uint64_t>(1000 * (stops + 1));
    };
    resumed = build_map(scene, options);
  }
  CHECK(stops > 2);
  check_same(whole.map, resumed.map);
  // The same photons forward are other work.
  options.hooks = {};
  options.settings.direction = MapDirection::forward;
  check_contains(complaint_of([&] { build_map(scene, options); }), {"m.h5.journal", "other work"});
}

TEST_CASE("A fit that was stopped again and again is the one of an uninterrupted process") {
  const auto folder = scratch_folder("resumed_fit");
  std::ofstream(folder / "light.csv") << "0.5,0.20,0.01\n1.5,0.18,0.01\n2.5,0.165,0.01\n3.5,0.15,0.01\n";
  const scene_file::SceneFile scene = scene_of(fitted_scene(folder / "light.csv"));
  const analysis::FitRecord whole = fit_scene(scene, {});
  SceneFitOptions options;
  options.model.journal = JournalSettings{folder / "f.h5.journal", JournalStart::resume};
  std::optional<analysis::FitRecord> resumed;
  int stops = 0;
  for (; !resumed; ++stops) {
    REQUIRE(stops < 100);
    std::atomic<bool> stop{false};
    int points = 0;
    std::uint64_t last = 0;
    options.model.stop = &stop;
    options.model.progress = [&](std::uint64_t done, std::uint64_t of) {
      if (done < last || done >= of) ++points;
      last = done;
      if (points > 5) stop = true;  // after about five curves more
    };
    const analysis::FitRecord record = fit_scene(scene, options);
    if (record.fit.end != analysis::FitEnd::stopped) resumed = record;
  }
  CHECK(stops > 2);
  CHECK(resumed->fit.end == whole.fit.end);
  REQUIRE(resumed->fit.parameters.size() == 1);
  CHECK(resumed->fit.parameters[0].value.value == whole.fit.parameters[0].value.value);
  CHECK(resumed->fit.parameters[0].value.error == whole.fit.parameters[0].value.error);
  CHECK(resumed->fit.scale.value == whole.fit.scale.value);
  CHECK(resumed->fit.goodness.chi2 == whole.fit.goodness.chi2);
  CHECK(resumed->fit.residual == whole.fit.residual);
  CHECK(resumed->fit.steps.size() == whole.fit.steps.size());
}
