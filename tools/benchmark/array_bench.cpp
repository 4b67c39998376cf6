/// Building and tracing large scenes: arrays of 1, 100 and 1600 crystals, and one part of a million
/// triangles, each against Embree alone on the same triangles.

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>

#include "bench.hpp"
#include "prepared.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

namespace scintray::bench {

namespace {

constexpr int kRounds = 5;
constexpr std::size_t kRawRays = 500'000;

/// N x N crystals 0.1 mm apart, each with its grease and its detector; light is made in the middle one.
/// Bare polished crystals share their light through the gaps; painted ones keep it.
std::string array_scene(int n, const std::string& accelerator, const std::string& surface) {
  return fmt::format(R"(
ambient = "vacuum"
[[array]]
name = "crystal"
count = [{0}, {0}]
gap = "0.1 mm"
[array.element]
box = ["2 mm", "2 mm", "20 mm"]
medium = "LSO_roncali2013"
surface = "{3}"
[[array.element.face]]
select = {{ normal = [0, 0, -1] }}
surface = "polished"
[[array]]
name = "grease"
count = [{0}, {0}]
gap = "0.1 mm"
place = {{ touch = "crystal", side = "-z" }}
[array.element]
box = ["2 mm", "2 mm", "0.1 mm"]
medium = "optical_grease_roncali2013"
surface = "polished"
[[array]]
name = "pad"
count = [{0}, {0}]
gap = "0.1 mm"
place = {{ touch = "grease", side = "-z" }}
[array.element]
box = ["2 mm", "2 mm", "1 mm"]
medium = "optical_grease_roncali2013"
sensor = "ideal"
[source]
type = "photons"
region = {{ part = "crystal[{1},{1}]" }}
wavelength = "420 nm"
photons = 100_000
[run]
accelerator = "{2}"
)",
                     n, n / 2, accelerator, surface);
}

/// A ball of 20 x 224^2 triangles in air.
std::string ball_scene() {
  return R"(
ambient = "vacuum"
[[part]]
name = "ball"
sphere = { radius = "10 mm", subdivisions = 224 }
medium = "LSO_roncali2013"
surface = "polished"
[[part]]
name = "eye"
box = { low = ["-1 mm", "-1 mm", "12 mm"], high = ["1 mm", "1 mm", "13 mm"] }
sensor = "ideal"
[source]
type = "photons"
region = { part = "ball" }
wavelength = "420 nm"
photons = 30_000
[run]
max_interactions = 200
)";
}

/// Megabytes in use now.
double resident_MB() {
  ::malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

struct Built {
  Prepared prepared;
  double seconds = 0.0, megabytes = 0.0;
};

Built build(const std::string& text, scene::SceneBuilder& builder) {
  Built result;
  const double before = resident_MB();
  const auto start = std::chrono::steady_clock::now();
  result.prepared = prepare(text, builder);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.megabytes = resident_MB() - before;
  return result;
}

}  // namespace

void bench_arrays() {
  scene::SceneBuilder builder;
  struct Case {
    std::string name, text;
    const char* part;
    std::vector<scene::BoundaryTriangle> triangles;
    Built built;
    std::vector<Speed> speed;
    std::vector<double> raw;
  };
  std::vector<Case> cases;
  const std::vector<scene::BoundaryTriangle> crystal =
      triangles_of(mesh::make_box({-1, -1, -10}, {1, 1, 10}));
  for (const char* surface : {"polished", "polished_lambertian_097"})
    for (const int n : {1, 10, 40})
      for (const char* accelerator : {"auto", "embree"})
        cases.push_back({fmt::format("{}, {}, {}", n * n, accelerator, surface),
                         array_scene(n, accelerator, surface),
                         "crystal",
                         crystal,
                         {},
                         {},
                         {}});
  cases.push_back({"ball of a million triangles",
                   ball_scene(),
                   "ball",
                   triangles_of(mesh::make_sphere(10.0, 224)),
                   {},
                   {},
                   {}});

  for (Case& c : cases) c.built = build(c.text, builder);
  std::vector<std::vector<RawRay>> rays;
  std::vector<std::unique_ptr<RawEmbree>> raw;
  for (const Case& c : cases) {
    rays.push_back(record_rays(c.built.prepared, kRawRays));
    raw.push_back(std::make_unique<RawEmbree>(c.triangles));
  }
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < cases.size(); ++i) {
      cases[i].raw.push_back(raw[i]->rays_per_second(rays[i]));
      cases[i].speed.push_back(measure(cases[i].built.prepared, 1));
    }

  std::cout << fmt::format(
      "arrays of 2 x 2 x 20 mm3 LSO, polished, with grease and detectors; one thread; medians of {} "
      "rounds\n\n",
      kRounds);
  std::cout << fmt::format("{:<38} {:>8} {:>10} {:>9} {:>12} {:>12} {:>12} {:>14}\n", "scene", "regions",
                           "build s", "MB", "Mseg/s", "Mphot/s", "seg/raw ray", "to 1 crystal");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    std::vector<double> segments, photons, per_raw, to_one;
    for (std::size_t r = 0; r < static_cast<std::size_t>(kRounds); ++r) {
      segments.push_back(c.speed[r].segments / 1e6);
      photons.push_back(c.speed[r].photons / 1e6);
      per_raw.push_back(c.speed[r].segments / c.raw[r]);
      to_one.push_back(c.speed[r].segments / cases[i - i % 6 + i % 2].speed[r].segments);
    }
    std::cout << fmt::format("{:<38} {:>8} {:>10.2f} {:>9.0f} {:>12.2f} {:>12.3f} {:>12.2f} {:>14}\n", c.name,
                             c.built.prepared->scene().regions.size(), c.built.seconds, c.built.megabytes,
                             median(segments), median(photons), median(per_raw),
                             i + 1 < cases.size() ? fmt::format("{:.2f}", median(to_one)) : "-");
  }
}

}  // namespace scintray::bench
