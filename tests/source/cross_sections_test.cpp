#include "scintray/source/detail/gamma/cross_sections.hpp"

#include <xraylib/xraylib.h>

#include "event_scene.hpp"
#include "scintray/materials/database.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::source;
using namespace scintray::test;

namespace {

struct Attenuation {
  double energy_keV;
  double cm2_per_g;
};

/// Checks the total attenuation of a substance against published numbers.
void check_attenuation(const std::string& formula, const std::vector<Attenuation>& published,
                       double tolerance) {
  const GammaMatter matter(composition_of_formula(formula), 1.0);
  for (const Attenuation& point : published) {
    CAPTURE(formula);
    CAPTURE(point.energy_keV);
    CHECK(10.0 * matter.total_per_mm(point.energy_keV) ==
          doctest::Approx(point.cm2_per_g).epsilon(tolerance));
  }
}

}  // namespace

// NIST: J. H. Hubbell and S. M. Seltzer 1995, NISTIR 5632, tables 3 and 4, where coherent scattering is
// included. Tolerances: xraylib's photoelectric tables are another evaluation (1 to 2 %); the fit of pair
// production is good to 5 % of its share, which is 28 % of lead's total at 3 MeV.
TEST_CASE("total attenuation agrees with NIST's tables") {
  check_attenuation("H2O",
                    {{10.0, 5.329},
                     {100.0, 0.1707},
                     {500.0, 0.09687},
                     {600.0, 0.08956},
                     {1000.0, 0.07072},
                     {1500.0, 0.05754},
                     {2000.0, 0.04942},
                     {3000.0, 0.03969}},
                    0.01);
  check_attenuation(
      "Fe", {{10.0, 170.6}, {100.0, 0.3717}, {500.0, 0.08414}, {1000.0, 0.05995}, {2000.0, 0.04265}}, 0.02);
  check_attenuation("Pb",
                    {{10.0, 130.6},
                     {100.0, 5.549},
                     {500.0, 0.1614},
                     {600.0, 0.1248},
                     {800.0, 0.08870},
                     {1000.0, 0.07102},
                     {1250.0, 0.05876},
                     {1500.0, 0.05222},
                     {2000.0, 0.04606},
                     {3000.0, 0.04234}},
                    0.02);
}

TEST_CASE("LSO attenuates 511 keV by 0.87 /cm") {
  // C. L. Melcher and J. S. Schweitzer 1992, IEEE Trans. Nucl. Sci. 39 502: attenuation length 1.14 cm to
  // 1.15 cm, 0.87 /cm.
  const Medium lso = MaterialDatabase::shipped().medium("LSO");
  const GammaMatter matter(lso.composition, lso.density_g_per_cm3);
  CHECK(10.0 * matter.total_per_mm(511.0) == doctest::Approx(0.87).epsilon(0.03));
}

TEST_CASE("the parts make the whole, and edges are sharp") {
  const GammaMatter lso(composition_of_formula("Lu2SiO5"), 7.4);
  for (double energy_keV = 10.0; energy_keV <= 3000.0; energy_keV *= 1.0371) {
    double sum = 0.0;
    for (const GammaProcess process : kGammaProcesses) sum += lso.per_mm(process, energy_keV);
    CHECK(sum == doctest::Approx(lso.total_per_mm(energy_keV)).epsilon(1e-12));
  }
  // Lutetium's K edge at 63.31 keV is a jump by a factor of five.
  const double below = lso.per_mm(GammaProcess::photoelectric, 63.29);
  const double above = lso.per_mm(GammaProcess::photoelectric, 63.34);
  CHECK(above / below > 4.5);
  CHECK(lso.per_mm(GammaProcess::pair, 1020.0) == 0.0);
  CHECK(lso.per_mm(GammaProcess::pair, 1300.0) > 0.0);
}

TEST_CASE("interpolation is finer than the data") {
  const ElementData lutetium(71);
  const GammaMatter matter(composition_of_formula("Lu"), 1.0);
  for (double energy_keV = 10.3; energy_keV < 3000.0; energy_keV *= 1.17)
    for (const GammaProcess process : kGammaProcesses) {
      CAPTURE(energy_keV);
      const double exact = 0.1 * lutetium.cross_section_cm2_per_g(process, energy_keV);
      CHECK(std::abs(matter.per_mm(process, energy_keV) - exact) <=
            1e-3 * exact + 1e-6 * matter.total_per_mm(energy_keV));
    }
}

TEST_CASE("integrals of the angular distributions are the tabulated cross sections") {
  // xraylib's own tables (B. L. Henke, J. H. Hubbell et al.) end at 800 keV.
  for (const int z : {1, 8, 14, 71, 83}) {
    const ElementData element(z);
    for (const double energy_keV : {10.5, 33.0, 100.0, 511.0, 790.0}) {
      CAPTURE(z);
      CAPTURE(energy_keV);
      CHECK(element.cross_section_cm2_per_g(GammaProcess::compton, energy_keV) ==
            doctest::Approx(CS_Compt(z, energy_keV, nullptr)).epsilon(0.01));
      CHECK(element.cross_section_cm2_per_g(GammaProcess::rayleigh, energy_keV) ==
            doctest::Approx(CS_Rayl(z, energy_keV, nullptr)).epsilon(0.03));
    }
  }
}

TEST_CASE("processes and elements are drawn in proportion") {
  // 200 000 draws; each share within 4.5 standard errors: false alarm below 1 in 30 000 for the four.
  const GammaMatter lso(composition_of_formula("Lu2SiO5"), 7.4);
  constexpr int kDraws = 200000;
  std::array<int, 4> counts{};
  Rng rng(7, StreamKind::other, 0);
  for (int i = 0; i < kDraws; ++i) ++counts[static_cast<std::size_t>(lso.sample(1500.0, rng).process)];
  for (const GammaProcess process : kGammaProcesses) {
    const double p = lso.per_mm(process, 1500.0) / lso.total_per_mm(1500.0);
    const double error = std::sqrt(p * (1.0 - p) / kDraws);
    CHECK(std::abs(static_cast<double>(counts[static_cast<std::size_t>(process)]) / kDraws - p) <
          4.5 * error);
  }
}
