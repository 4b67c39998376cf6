// Divergence, light spread and etendue against closed forms.
#include "scintray/analysis/light_analysis.hpp"

#include <doctest/doctest.h>

#include "physics/traced.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;
using doctest::Approx;

namespace {

/// Light with Lambert's law from just under a face of `width` mm, in index 1.5, where it is detected.
std::string lambertian(double width_mm, const std::string& tallies) {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "block"
box = ["{0} mm", "3 mm", "1 mm"]
medium = "n15"
surface = "flat"
[[part.face]]
name = "exit"
select = {{ normal = [0, 0, 1] }}
[[part]]
name = "eye"
box = {{ low = ["-{0} mm", "-3 mm", "1 mm"], high = ["{0} mm", "3 mm", "2 mm"] }}
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = {{ part = "block", slab_z = ["0.9999999 mm", "1 mm"] }}
direction = {{ lambertian = [0, 0, 1] }}
wavelength = "500 nm"
photons = 200_000
)",
                     width_mm) +
         tallies;
}

}  // namespace

TEST_CASE("Lambert's law diverges by 45 deg for half of the light and fills its etendue") {
  const Traced traced = trace(lambertian(2.0, R"(
[[tally]]
type = "etendue"
name = "G"
face = "block:exit"
[[tally]]
type = "exit_angle"
face = "block:exit"
bins = 900
[[tally]]
type = "irradiance"
name = "E"
face = "block:exit"
pixels = [4, 6]
)"));
  const Etendue etendue = read_etendue(find_tally(traced.result, "G"));
  const double whole = 1.5 * 1.5 * 2.0 * 3.0 * kPi;
  CHECK(etendue.index == Approx(1.5));
  CHECK(etendue.grid_mm2_sr == Approx(whole));
  check_law("etendue of a face that radiates by Lambert's law", etendue.filled_mm2_sr, {whole, 0.0});
  CHECK(etendue.filled_mm2_sr.error < 0.01 * whole);

  const Divergence spread = divergence(crossing_angles(traced.result).at(0).inside);
  check_law("half-angle of half of the light, rad", spread.half_rad, {0.25 * kPi, 0.0});
  check_law("half-angle of nine tenths, rad", spread.ninety_rad, {std::asin(std::sqrt(0.9)), 0.0});
  check_law("mean cosine", spread.mean_cosine, {2.0 / 3.0, 0.0});

  const LightSpread even = light_spread(find_tally(traced.result, "E"));
  CHECK(sigmas({even.centre_mm[0], even.centre_error_mm[0]}, {0.0, 0.0}) < kSigmas);
  CHECK(even.rms_mm[0] == Approx(2.0 * std::sqrt((1.0 - 1.0 / 16.0) / 12.0)).epsilon(0.01));
  CHECK(even.fwhm_mm[1] == Approx(3.0));
}

TEST_CASE("A cone of half the sine fills a quarter of the etendue") {
  std::string scene = lambertian(
      2.0, "[[tally]]\ntype = \"etendue\"\nname = \"G\"\nface = \"block:exit\"\npolar_bins = 16\n");
  // Uniform in solid angle is not Lambert's law, but nearly so in a narrow cone: L varies by 1 / cos.
  scene.replace(scene.find("{ lambertian = [0, 0, 1] }"), 26,
                "{ cone = [0, 0, 1], half_angle = \"30 deg\" }");
  const Traced traced = trace(scene);
  const Etendue etendue = read_etendue(find_tally(traced.result, "G"));
  // dN = dOmega / Omega, dG = n^2 A cos dOmega: G = n^2 A (2 pi (1 - c)) / mean(1 / cos), c = cos 30 deg.
  const double c = std::cos(kPi / 6.0);
  const double expected = 1.5 * 1.5 * 6.0 * kTwoPi * (1.0 - c) / (-std::log(c) / (1.0 - c));
  check_law("etendue of a cone", etendue.filled_mm2_sr, {expected, 0.0});
}

TEST_CASE("A tally of another kind says so") {
  const Traced traced = trace(lambertian(2.0, "[[tally]]\ntype = \"ledger\"\nname = \"L\"\n"));
  CHECK_THROWS_WITH_AS(read_etendue(traced.result.tallies[0]), doctest::Contains("is no etendue"),
                       InputError);
  CHECK_THROWS_WITH_AS(light_spread(traced.result.tallies[0]), doctest::Contains("no grid"), InputError);
  CHECK(contains(complaint_of([&] { find_tally(traced.result, "K"); }), "there are: L"));
}
