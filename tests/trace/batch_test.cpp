#include "scintray/transport/batch.hpp"

#include <array>
#include <vector>

#include "crystal_on_sensor.hpp"
#include "physics/traced.hpp"
#include "scintray/core/lane_width.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// The end of a photon that is traced one step after another, and its segments.
struct TracedAlone {
  source::Photon photon;
  std::uint64_t segments = 0;
};
TracedAlone traced_alone(const scene::Scene& scene, const transport::PropagationLimits& limits,
                         const source::Photon& photon, core::Rng rng) {
  TracedAlone end{photon};
  for (;;) {
    const transport::Step step = transport::step(scene, end.photon, rng, limits);
    end.segments += step.segments;
    if (core::is_final(step.event) || limits.reached(end.photon)) return end;
  }
}
void check_end(const transport::TracedPhoton& end, const TracedAlone& alone) {
  CHECK(end.photon.position.z() == alone.photon.position.z());
  CHECK(end.photon.path_mm == alone.photon.path_mm);
  CHECK(end.segments_before + end.last.segments == alone.segments);
}

}  // namespace

TEST_CASE("Photons in parts of one shape are propagated together, whichever part they are in") {
  if (core::lane_widths().back() == 1) return;
  // Polished crystals in vacuum, each by itself; photons start in all of them in turn.
  const auto mean_group = [](int crystals) {
    const std::string count = "[" + std::to_string(crystals) + ", 1]";
    const auto point = ready(scene_spec(R"(
ambient = "vacuum"
[[array]]
name = "crystal"
count = )" + count + R"(
pitch = "5 mm"
[array.element]
box = ["2 mm", "2 mm", "4 mm"]
medium = "LSO_roncali2013"
surface = "polished"
[source]
type = "photons"
region = { part = "crystal[0,0]" }
wavelength = "420 nm"
photons = 4000
)"));
    const scene::Scene& scene = point->scene();
    const core::RegionId first = point->start(0, 0).region;
    std::vector<core::RegionId> starts;
    for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
      if (scene.regions[core::RegionId(i)].accelerator == scene.regions[first].accelerator)
        starts.emplace_back(i);
    REQUIRE(starts.size() == static_cast<std::size_t>(crystals));
    const int width = core::lane_widths().back();
    const transport::LanePlan lanes(scene, width);
    REQUIRE(lanes.kind(first) == transport::LaneKind::smooth);
    transport::PropagationLimits limits;
    limits.interactions = 1000;
    transport::Batch batch(scene, limits, lanes);
    const auto emit = [&](std::uint64_t i, std::span<source::EmittedPhoton* const> photons) {
      for (source::EmittedPhoton* const emitted : photons) {
        emitted->rng = photon_stream(RunSettings{}, i / 1000, i % 1000);
        source::Photon& photon = emitted->photon = point->start(i / 1000, i % 1000);
        photon.region = starts[i++ % starts.size()];
        photon.position += scene.regions[photon.region].centre.vec() - scene.regions[first].centre.vec();
      }
    };
    std::uint64_t next = 0;
    batch.trace(4000, emit, [&](std::uint64_t i, const transport::TracedPhoton&) { CHECK(i == next++); });
    CHECK(next == 4000);
    REQUIRE(batch.counts().groups > 0);
    return static_cast<double>(batch.counts().grouped) / static_cast<double>(batch.counts().groups);
  };
  const double one = mean_group(1);
  CHECK(one > 50.0);
  CHECK(mean_group(16) > 0.9 * one);  // a sixteenth, were each part by itself
}

TEST_CASE("Photons whose random numbers have other seeds are traced beside each other") {
  const auto point = ready(scene_spec(crystal("paint", kPaint)));
  const auto stream = [](std::uint64_t i) {
    RunSettings settings;
    settings.seed += i % 3;
    return photon_stream(settings, 0, i);
  };
  const auto emit = [&](std::uint64_t i, std::span<source::EmittedPhoton* const> photons) {
    for (source::EmittedPhoton* const emitted : photons) {
      emitted->rng = stream(i);
      emitted->photon = point->start(0, i++);
    }
  };
  transport::PropagationLimits limits;
  limits.interactions = 1000;
  for (const int width : core::lane_widths()) {
    CAPTURE(width);
    const transport::LanePlan lanes(point->scene(), width);
    transport::Batch batch(point->scene(), limits, lanes);
    batch.trace(600, emit, [&](std::uint64_t i, const transport::TracedPhoton& end) {
      check_end(end, traced_alone(point->scene(), limits, point->start(0, i), stream(i)));
    });
  }
}

TEST_CASE("Ends arrive in the order of photons, however many others end before one of them") {
  // Every thousandth photon starts in a painted crystal, the others beside it, and leave the scene at once.
  const auto point = ready(scene_spec(crystal("paint", kPaint)));
  const scene::Scene& scene = point->scene();
  const auto inside = [](std::uint64_t i) { return i % 1000 == 0; };
  const auto stream = [](std::uint64_t i) { return photon_stream(RunSettings{}, 0, i); };
  const auto emit_one = [&](std::uint64_t i, core::Rng& rng) {
    source::Photon photon = point->start(i / 1000, i % 1000);
    if (inside(i)) {
      rng.bits();  // the streams of a run have gone on by then; any place will do
      return photon;
    }
    photon.region = scene::kAmbientRegion;
    photon.position = core::Vec3(50, 60, 70 + static_cast<double>(i));
    photon.ray.direction = core::Vec3(1, 0, 0);
    photon.ray.polarisation = core::Vec3(0, 1, 0);
    photon.optics = scene.optics.at(scene.regions[photon.region].medium, photon.wavelength_nm);
    return photon;
  };
  const auto emit = [&](std::uint64_t i, std::span<source::EmittedPhoton* const> photons) {
    for (source::EmittedPhoton* const emitted : photons) {
      emitted->rng = stream(i);
      emitted->photon = emit_one(i++, emitted->rng);
    }
  };
  transport::PropagationLimits limits;
  limits.interactions = 1000;
  for (const int width : core::lane_widths()) {
    CAPTURE(width);
    const transport::LanePlan lanes(scene, width);
    transport::Batch batch(scene, limits, lanes);
    for (int call = 0; call < 2; ++call) {  // a batch serves again
      std::uint64_t next = 0;
      batch.trace(3000, emit, [&](std::uint64_t i, const transport::TracedPhoton& end) {
        REQUIRE(i == next++);
        if (!inside(i)) {
          CHECK(end.last.event == core::StepEvent::escaped);
          CHECK(end.photon.position.z() == 70.0 + static_cast<double>(i));
          return;
        }
        core::Rng rng = stream(i);
        const source::Photon photon = emit_one(i, rng);
        check_end(end, traced_alone(scene, limits, photon, rng));
      });
      CHECK(next == 3000);
    }
  }
}

TEST_CASE("Blocks traced together have the results of blocks traced one by one") {
  // Enough photons for one thread that two blocks make a piece of work.
  SceneSpec spec = scene_spec(replaced(crystal("paint", kPaint), "photons = 3_000", "photons = 140_000"));
  spec.run.threads = 1;
  scene::SceneBuilder builder(tables_of_this_build());
  const TracedPhotons alone = trace_with(spec, 1, builder);
  const int width = core::lane_widths().back();
  check_same(alone, trace_with(spec, width, builder));

  // Ranges end where they did, with what is theirs, and a run ends at the block that is enough.
  const auto ranges = [&](int lanes) {
    spec.run.lane_width = lanes;
    std::vector<std::array<std::uint64_t, 4>> found;
    std::uint64_t blocks = 0;
    RunHooks hooks;
    hooks.range_ends = [](const BlockRange& present) { return present.count() == 3; };
    hooks.range = [&](const BlockRange& range, PointSums sums) {
      blocks = range.last;
      found.push_back({range.first, range.last, sums.counts.photons, sums.counts.segments});
    };
    hooks.enough = [&] { return blocks >= 27; };
    const PointResult result = SimulationPoint(spec, builder).trace(hooks);
    CHECK(result.photons == 27 * 1024);
    return found;
  };
  const auto expected = ranges(1);
  CHECK(expected.size() == 9);
  CHECK(ranges(width) == expected);
}
