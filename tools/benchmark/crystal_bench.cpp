/// Speed of the tracer on the paper's crystal, against Embree alone, in one run.
///
/// Every round measures each case once, one after the other, so that a change of the machine's speed
/// meets all of them; the figures are medians over rounds, the ratios medians of ratios within a round.

#include <fmt/format.h>

#include <iostream>
#include <vector>

#include "bench.hpp"
#include "prepared.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

namespace {

using namespace scintray;
using namespace scintray::mesh;
using namespace scintray::topography;
using namespace scintray::scene;

constexpr int kRounds = 7;
constexpr std::size_t kRawRays = 1'000'000;

struct Case {
  std::string name, surface, accelerator;
  std::uint64_t photons;
};

const std::vector<Case> kCases{
    {"polished, Embree", "polished", "embree", 160'000},
    {"polished, planes", "polished", "planes", 320'000},
    {"UNIFIED 18 deg, planes", "roncali2013_unified_rough", "planes", 800'000},
    {"table of ground, planes", "lso_ground_30um", "planes", 800'000},
};

std::string scene_text(const Case& c) {
  return fmt::format(R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "LSO_roncali2013"
surface = "{}"
[[part.face]]
name = "exit"
select = {{ normal = [0, 0, -1] }}
surface = "polished"
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease_roncali2013" }}
medium = "optical_grease_roncali2013"
sensor = "ideal"
[source]
type = "photons"
region = {{ part = "crystal", slab_z = ["9.25 mm", "10.75 mm"] }}
wavelength = "420 nm"
photons = {}
[run]
accelerator = "{}"
)",
                     c.surface, c.photons, c.accelerator);
}

}  // namespace

namespace scintray::bench {

void bench_crystal() {
  SceneBuilder builder;
  std::vector<Prepared> prepared;
  for (const Case& c : kCases) prepared.push_back(prepare(scene_text(c), builder));
  const std::vector<RawRay> rays = record_rays(prepared[0], kRawRays);
  RawEmbree raw(triangles_of(make_box({-1, -1, -10}, {1, 1, 10})));

  std::vector<double> raw_speed;
  std::vector<std::vector<Speed>> one(kCases.size()), two(kCases.size());
  raw.rays_per_second(rays);
  for (int round = 0; round < kRounds; ++round) {
    raw_speed.push_back(raw.rays_per_second(rays));
    for (std::size_t i = 0; i < kCases.size(); ++i) {
      one[i].push_back(measure(prepared[i], 1));
      two[i].push_back(measure(prepared[i], 2));
    }
  }

  std::cout << fmt::format(
      "2 x 2 x 20 mm3 LSO, bare, depth 10 mm; medians of {} rounds (checksum {:.6g})\n\n", kRounds,
      raw.checksum());
  std::cout << fmt::format("{:<26} {:>14}\n", "Embree alone, 1 thread",
                           fmt::format("{:.2f} Mrays/s", median(raw_speed) / 1e6));
  std::cout << fmt::format("\n{:<26} {:>12} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "case", "Mseg/s, 1 t",
                           "Mphot/s, 1 t", "Mseg/s, 2 t", "Mphot/s, 2 t", "seg/raw ray", "2 t / 1 t");
  const auto column = [&](const std::vector<Speed>& speeds, double Speed::*what) {
    std::vector<double> values;
    for (const Speed& s : speeds) values.push_back(s.*what);
    return median(values) / 1e6;
  };
  for (std::size_t i = 0; i < kCases.size(); ++i) {
    std::vector<double> per_raw, scaling;
    for (int round = 0; round < kRounds; ++round) {
      const auto r = static_cast<std::size_t>(round);
      per_raw.push_back(one[i][r].segments / raw_speed[r]);
      scaling.push_back(two[i][r].segments / one[i][r].segments);
    }
    std::cout << fmt::format("{:<26} {:>12.2f} {:>12.3f} {:>12.2f} {:>12.3f} {:>12.2f} {:>10.2f}\n",
                             kCases[i].name, column(one[i], &Speed::segments),
                             column(one[i], &Speed::photons), column(two[i], &Speed::segments),
                             column(two[i], &Speed::photons), median(per_raw), median(scaling));
  }
  std::vector<double> table_to_unified;
  for (std::size_t r = 0; r < kRounds; ++r)
    table_to_unified.push_back(one[3][r].segments / one[2][r].segments);
  std::cout << fmt::format("\ntable to UNIFIED, segments/s: {:.2f}\n", median(table_to_unified));
}

}  // namespace scintray::bench
