#include <fmt/format.h>

#include <array>

#include "physics/crystal_scene.hpp"
#include "physics/traced.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

/// An independent program's numbers: 2 x 2 x 20 mm3, rough Gaussian map on five faces, 100,000 photons a
/// depth; tests/reference/README.md describes the geometry.
struct Depth {
  double z_mm, detected, interactions;
};
constexpr std::array<Depth, 5> kRough{
    {{2, 0.2117, 3.55}, {6, 0.1237, 3.90}, {10, 0.0764, 4.09}, {14, 0.0496, 4.11}, {18, 0.0363, 4.12}}};
constexpr double kReferencePhotons = 100'000;
/// Share of photons that the reference program states it may have misclassified.
constexpr double kReferenceSystematic = 0.003;

std::string rough_map() { return source_file("tests/reference/microsurface/gaussian_rough.gsf").string(); }

std::string scene_text(double z_mm, const std::string& map, const std::string& mode, std::uint64_t photons) {
  return rough_crystal(z_mm, {map, "none", true, mode}, photons);
}

void compare_with_reference(const std::string& mode) {
  const std::string map = rough_map();
  for (const Depth& depth : kRough) {
    const PointResult result = trace(scene_text(depth.z_mm, map, mode, 200'000)).result;
    const Estimate detected = result.fraction(Fate::detected);
    const Estimate reference = binomial_estimate(
        static_cast<std::uint64_t>(depth.detected * kReferencePhotons + 0.5), kReferencePhotons);
    const double combined = std::hypot(detected.error, reference.error);
    const double allowed = kSigmas * combined + kReferenceSystematic * reference.value;
    evidence(
        "microsurface_crystal",
        {mode == "table" ? "table" : "traced on the spot", fmt::format("{:g} mm", depth.z_mm),
         fmt::format("{:.4f} ± {:.4f}", detected.value, detected.error),
         fmt::format("{:.4f} ± {:.4f}", reference.value, reference.error),
         fmt::format("{:+.2f}", (detected.value - reference.value) / combined),
         fmt::format("{:.3f}", result.interactions.mean().value), fmt::format("{:.2f}", depth.interactions)});
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
  const std::string map = rough_map();
  for (const double z : {2.0, 18.0}) {
    const PointResult spot = trace(scene_text(z, map, "on_the_spot", 400'000)).result;
    const PointResult table = trace(scene_text(z, map, "table", 400'000)).result;
    for (const Fate fate : {Fate::detected, Fate::escaped, Fate::absorbed_in_medium}) {
      CAPTURE(z);
      CAPTURE(fate_name(fate));
      evidence("table_against_map",
               {"Gaussian, Sq 0.9 um", fmt::format("{:g} mm", z), std::string(fate_name(fate)),
                fmt::format("{:.5f} ± {:.5f}", table.fraction(fate).value, table.fraction(fate).error),
                fmt::format("{:.5f} ± {:.5f}", spot.fraction(fate).value, spot.fraction(fate).error),
                fmt::format("{:.2f}", sigmas(spot.fraction(fate), table.fraction(fate)))});
      CAPTURE(spot.fraction(fate).value);
      CAPTURE(table.fraction(fate).value);
      CHECK(sigmas(spot.fraction(fate), table.fraction(fate)) < kSigmas);
    }
  }
}
