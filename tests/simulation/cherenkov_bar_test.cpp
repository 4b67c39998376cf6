// Cherenkov light of a fast particle across a bar, as in a detector of internally reflected Cherenkov light.
#include <cmath>
#include <fstream>

#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

TEST_CASE("Law: the cone of Cherenkov light is kept along a bar, and all of it is trapped for beta = 1") {
  // In a bar of index n along z, a particle along y: the cosine to y is 1 / (beta n) at every reflection, and
  // light is reflected totally at all sides where that to the normal is below sqrt(1 - 1 / n^2). For n = 1.5
  // and beta = 1 this holds for the whole cone.
  constexpr double kIndex = 1.5, kBeta = 1.0;
  const std::filesystem::path file = scratch_folder("bar") / "steps.csv";
  std::ofstream steps(file);
  steps << "event,x,y,z,energy,time,dx,dy,dz,beta,charge\n";
  for (int event = 0; event < 20; ++event) steps << event << ",1,-9.999,-20,0,0,0,19.998,0,1,-1\n";
  steps.close();
  const Traced traced = trace(fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "bar"
box = {{ low = ["-10 mm", "-10 mm", "-200 mm"], high = ["10 mm", "10 mm", "200 mm"] }}
medium = "n15"
surface = "flat"
[[part]]
name = "above"
box = {{ low = ["-10 mm", "-10 mm", "200 mm"], high = ["10 mm", "10 mm", "201 mm"] }}
medium = "n15"
surface = "flat"
sensor = "perfect"
[[part]]
name = "below"
box = {{ low = ["-10 mm", "-10 mm", "-201 mm"], high = ["10 mm", "10 mm", "-200 mm"] }}
medium = "n15"
surface = "flat"
sensor = "perfect"
[source]
type = "hits"
file = "{}"
length_unit = "mm"
energy_unit = "keV"
time_unit = "ns"
cherenkov = true
cherenkov_range = ["300 nm", "600 nm"]
columns = {{ dx = "dx", dy = "dy", dz = "dz", beta = "beta", charge = "charge" }}
[run]
photon_list = true
)",
                                          file.string()));
  const PointResult& result = traced.result;
  // 2 pi alpha (1 - 1 / (beta n)^2) (1 / 300 nm - 1 / 600 nm) per length, of 20 steps of 19.998 mm.
  const double expected = kTwoPi / 137.035999 * (1.0 - 1.0 / (kIndex * kIndex)) / 600.0 * 1e6 * 19.998 * 20.0;
  check_law("photons of 20 particles", {static_cast<double>(result.emitted), std::sqrt(expected)},
            {expected, 1e-4 * expected});
  simulation::RunHooks hooks;
  std::uint64_t all = 0, above = 0;
  hooks.detected = [&](const std::vector<DetectedPhoton>& photons) {
    for (const DetectedPhoton& photon : photons) {
      ++all;
      above += photon.position_mm[2] > 0.0f ? 1 : 0;
      CHECK(std::abs(photon.direction[1]) == doctest::Approx(1.0 / (kBeta * kIndex)).epsilon(1e-5));
    }
  };
  traced.point->trace(hooks);
  // Total reflection is at its limit for one azimuth of the cone alone.
  check_law("detected at the ends", {static_cast<double>(all) / static_cast<double>(result.emitted), 1e-3},
            {1.0, 0.0});
  check_law("at the upper end", binomial_estimate(above, all), {0.5, 0.0});
}
