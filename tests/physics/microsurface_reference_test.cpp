#include <fmt/format.h>

#include <array>
#include <iostream>

#include "physics/traced.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

/// An independent program's numbers: 2 x 2 x 20 mm3, rough Gaussian map on five faces, 100,000 photons a
/// depth; the README beside the maps describes the geometry.
struct Depth {
  double z_mm, detected, interactions;
};
constexpr std::array<Depth, 5> kRough{
    {{2, 0.2117, 3.55}, {6, 0.1237, 3.90}, {10, 0.0764, 4.09}, {14, 0.0496, 4.11}, {18, 0.0363, 4.12}}};
constexpr double kReferencePhotons = 100'000;
/// Share of photons that the reference program says it may have misclassified.
constexpr double kReferenceSystematic = 0.003;

std::string scene(double z_mm, const std::string& map, const std::string& mode, std::uint64_t photons) {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "lso_isotropic"
surface = "rough"
[[part.face]]
name = "exit"
select = {{ normal = [0, 0, -1] }}
surface = "flat"
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "-z" }}
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = {{ part = "crystal", slab_z = ["{} mm", "{} mm"] }}
wavelength = "420 nm"
polarisation = "unpolarised"
photons = {}
[surfaces.rough]
model = "height_map"
[surfaces.rough.height_map]
file = "{}"
level = "none"
periodic = true
[surfaces.rough.tracing]
mode = "{}"
)",
                     z_mm - 0.75, z_mm + 0.75, photons, map, mode);
}

void compare_with_reference(const std::string& mode) {
  const auto map = shared_file("reference/microsurface/gaussian_rough.gsf");
  if (!map) return;
  for (const Depth& depth : kRough) {
    const PointResult result = trace(scene(depth.z_mm, map->string(), mode, 200'000)).result;
    const Estimate detected = result.fraction(Fate::detected);
    const Estimate reference = binomial_estimate(
        static_cast<std::uint64_t>(depth.detected * kReferencePhotons + 0.5), kReferencePhotons);
    const double combined = std::hypot(detected.error, reference.error);
    const double allowed = kSigmas * combined + kReferenceSystematic * reference.value;
    std::cout << fmt::format(
        "  {:<12} z {:>4} mm: detected {:.4f} +- {:.4f}, reference {:.4f}; interactions {:.3f}, "
        "reference {:.2f}\n",
        mode, depth.z_mm, detected.value, detected.error, reference.value, result.interactions.mean().value,
        depth.interactions);
    CAPTURE(depth.z_mm);
    CHECK(std::abs(detected.value - reference.value) < allowed);
    // The reference's interactions are given to two decimals; its standard error is about 0.012.
    CHECK(std::abs(result.interactions.mean().value - depth.interactions) <
          kSigmas * 0.015 + kReferenceSystematic * depth.interactions + 0.005);
  }
}

}  // namespace

TEST_CASE("Microsurface: crystal with the map traced on the spot agrees with an independent program") {
  compare_with_reference("on_the_spot");
}

TEST_CASE("Microsurface: crystal with the table of the map agrees with an independent program") {
  compare_with_reference("table");
}

TEST_CASE("Microsurface: light output with the table equals that with the map traced on the spot") {
  const auto map = shared_file("reference/microsurface/gaussian_rough.gsf");
  if (!map) return;
  for (const double z : {2.0, 18.0}) {
    const PointResult spot = trace(scene(z, map->string(), "on_the_spot", 400'000)).result;
    const PointResult table = trace(scene(z, map->string(), "table", 400'000)).result;
    for (const Fate fate : {Fate::detected, Fate::escaped, Fate::absorbed_in_medium}) {
      CAPTURE(z);
      CAPTURE(fate_name(fate));
      CAPTURE(spot.fraction(fate).value);
      CAPTURE(table.fraction(fate).value);
      CHECK(sigmas(spot.fraction(fate), table.fraction(fate)) < kSigmas);
    }
  }
}
