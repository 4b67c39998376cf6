// The scenes of tools/bench: each is built and traced, and is found by its name.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "measure.hpp"
#include "raw_embree.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "workload.hpp"

using namespace scintray;
using namespace scintray::bench;

namespace {

std::vector<std::string> names_of(const std::vector<BenchScene>& scenes) {
  std::vector<std::string> names;
  for (const BenchScene& scene : scenes) names.push_back(scene.name);
  return names;
}

core::Problem problem_of(const std::vector<std::string>& patterns) {
  try {
    select_scenes(patterns);
  } catch (const core::InputError& error) {
    return error.problems().front();
  }
  FAIL("no error");
  return {};
}

}  // namespace

TEST_CASE(
    "Every benchmark scene traces photons without loss, and its rays hit the boundaries given to Embree") {
  for (const BenchScene& scene : scene_list()) {
    CAPTURE(scene.name);
    const Workload workload(scene);
    const std::uint64_t work = workload.has_events() ? 2 : 20;
    const Trace one = workload.trace(work, 1);
    CHECK((workload.has_events() ? one.events : one.photons) == work);
    CHECK(one.lost == 0);
    CHECK(one.segments > 0);
    CHECK(workload.trace(work, 2).segments == one.segments);

    constexpr std::size_t kRays = 500;
    const std::vector<RecordedRay> rays = record_rays(workload.point(), kRays);
    CHECK(rays.size() >= kRays);
    RawEmbree raw(workload.point().scene(), rays);
    CHECK(raw.rays_per_second(0.0) > 0.0);
    // All but those that leave the scene, at most one a photon.
    CHECK(raw.hits() > raw.rays() / 2);
  }
}

TEST_CASE("The crystal of 3072 triangles is the box of the other crystals") {
  const BenchScene& fine = scene_named("polished_3072");
  const bool has_mesh = fine.mesh != nullptr;
  REQUIRE(has_mesh);
  const mesh::TriMesh mesh = fine.mesh();
  CHECK(mesh.triangles.size() == 3072);
  CHECK(mesh.volume() == doctest::Approx(2.0 * 2.0 * 20.0));
}

TEST_CASE("Benchmark scenes have names of their own, and are compared with scenes that exist") {
  const std::vector<std::string> names = names_of(scene_list());
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  for (const BenchScene& scene : scene_list()) {
    if (scene.relative_to.empty()) continue;
    CAPTURE(scene.name);
    CHECK_NOTHROW(scene_named(scene.relative_to));
    CHECK(scene.relative_to != scene.name);
  }
}

TEST_CASE("Benchmark scenes are chosen by patterns, in the order of the list, each once") {
  CHECK(names_of(select_scenes({})) == names_of(scene_list()));
  CHECK(names_of(select_scenes({"table", "polished"})) == std::vector<std::string>{"polished", "table"});
  CHECK(names_of(select_scenes({"array_40_*", "array_40_bare"})) ==
        std::vector<std::string>{"array_40_bare", "array_40_wrapped"});
}

TEST_CASE("An unknown benchmark scene is an error that names it and the nearest one") {
  const core::Problem problem = problem_of({"polishd"});
  CHECK(problem.what.find("\"polishd\"") != std::string::npos);
  CHECK(problem.hint.find("\"polished\"") != std::string::npos);
  CHECK(problem_of({"polished", "zzz*"}).what.find("\"zzz*\"") != std::string::npos);
  CHECK_THROWS_AS(scene_named("polishd"), core::InputError);
}

TEST_CASE("A scene is measured at every lane width that is asked for, the first with more threads as well") {
  MeasureSettings settings;
  settings.seconds = 0.01;
  settings.rounds = 1;
  settings.lane_widths = core::lane_widths();
  settings.profile = false;
  const BenchScene& scene = scene_named("polished");
  const Workload workload(scene, settings.lane_widths.front());
  std::vector<std::uintptr_t> samples;
  const SceneFigures figures = measure(scene, workload, nullptr, settings, samples);
  REQUIRE(figures.runs.size() == settings.lane_widths.size() + 1);
  CHECK(figures.runs[1].threads == 2);
  CHECK_FALSE(figures.runs[1].lane_gain.has_value());
  for (std::size_t i = 1; i < settings.lane_widths.size(); ++i) {
    const RunFigures& run = figures.runs[i + 1];
    CHECK(run.threads == 1);
    CHECK(run.lane_width == settings.lane_widths[i]);
    CHECK(run.asked_lane_width == settings.lane_widths[i]);
    REQUIRE(run.lane_gain.has_value());
    CHECK(run.lane_gain->values[0] ==
          doctest::Approx(run.segments_per_s.values[0] / figures.runs[0].segments_per_s.values[0]));
  }
}

TEST_CASE("A scene is measured in rounds with every number of threads, a pair of values in each") {
  MeasureSettings settings;
  settings.seconds = 0.01;
  settings.rounds = 3;
  settings.threads = {2, 3};
  settings.profile = false;
  const BenchScene& scene = scene_named("array_20_wrapped");
  const Workload workload(scene), reference(scene_named(scene.relative_to));
  std::vector<std::uintptr_t> samples;
  const SceneFigures figures = measure(scene, workload, &reference, settings, samples);
  CHECK(samples.empty());
  REQUIRE(figures.runs.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const RunFigures& run = figures.runs[i];
    CHECK(run.threads == static_cast<int>(i) + 1);
    CHECK(run.lane_width == workload.point().lane_width());
    CHECK_FALSE(run.asked_lane_width.has_value());
    CHECK_FALSE(run.lane_gain.has_value());
    CHECK(run.segments_per_s.values.size() == 3);
    CHECK(run.speedup.has_value() == (i > 0));
    CHECK(run.cpu_cost.has_value() == (i > 0));
    CHECK_FALSE(run.events_per_s.has_value());
    // Both rates are of the same photons in the same time.
    CHECK(run.segments_per_s.values.front() / run.photons_per_s.values.front() ==
          doctest::Approx(figures.segments_per_photon));
  }
  CHECK(figures.lost == 0);
  REQUIRE(figures.segments_per_raw_ray.has_value());
  CHECK(figures.segments_per_raw_ray->values[1] ==
        doctest::Approx(figures.runs[0].segments_per_s.values[1] / figures.raw_embree_rays_per_s->values[1]));
  REQUIRE(figures.relative.has_value());
  CHECK(figures.relative->to == "array_1_wrapped");
}
