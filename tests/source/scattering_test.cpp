#include "scintray/source/detail/gamma/cross_sections.hpp"

#include <xraylib/xraylib.h>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::source;

namespace {

constexpr int kDraws = 200000;
constexpr std::size_t kBins = 50;

/// Chi-square of drawn cosines against a density, integrated over each of 50 bins by the midpoint rule.
template <class Draw, class Density>
double p_value(const Draw& draw, const Density& density) {
  std::vector<std::uint64_t> observed(kBins, 0);
  for (int i = 0; i < kDraws; ++i) {
    const double cosine = draw();
    REQUIRE(std::abs(cosine) <= 1.0 + 1e-12);
    ++observed[std::min(kBins - 1, static_cast<std::size_t>((cosine + 1.0) * 0.5 * kBins))];
  }
  std::vector<double> expected(kBins, 0.0);
  double sum = 0.0;
  constexpr int kPerBin = 400;
  for (std::size_t bin = 0; bin < kBins; ++bin)
    for (int i = 0; i < kPerBin; ++i)
      expected[bin] += density(-1.0 + 2.0 * (static_cast<double>(bin) + (i + 0.5) / kPerBin) / kBins);
  for (const double value : expected) sum += value;
  for (double& value : expected) value *= kDraws / sum;
  return chi_square_test(observed, expected).p_value;
}

/// Klein and Nishina's density of the cosine, up to a constant.
double klein_nishina(double energy_keV, double cosine) {
  const double ratio = compton_energy_keV(energy_keV, cosine) / energy_keV;
  return ratio * ratio * (ratio + 1.0 / ratio - 1.0 + cosine * cosine);
}

double half_sine(double cosine) { return std::sqrt(0.5 * (1.0 - cosine)); }

}  // namespace

// Each of these tests fails by chance once in 10 000 seeds.
TEST_CASE("angles on free electrons follow Klein and Nishina") {
  for (const double energy_keV : {15.0, 140.0, 511.0, 2615.0}) {
    CAPTURE(energy_keV);
    Rng rng(11, StreamKind::other, static_cast<std::uint64_t>(energy_keV));
    CHECK(p_value([&] { return sample_klein_nishina(energy_keV, rng).cosine; },
                  [&](double cosine) { return klein_nishina(energy_keV, cosine); }) > 1e-4);
  }
}

TEST_CASE("bound electrons take forward angles as their scattering function says") {
  const ElementData lutetium(71);
  for (const double energy_keV : {30.0, 88.0, 511.0}) {
    CAPTURE(energy_keV);
    Rng rng(12, StreamKind::other, static_cast<std::uint64_t>(energy_keV));
    CHECK(p_value([&] { return sample_compton(lutetium, energy_keV, rng).cosine; },
                  [&](double cosine) {
                    return klein_nishina(energy_keV, cosine) *
                           lutetium.incoherent(energy_keV * kPerAngstromPerkeV * half_sine(cosine));
                  }) > 1e-4);
  }
}

TEST_CASE("energy and angle of a Compton scattering belong together, and there is an edge") {
  const ElementData oxygen(8);
  Rng rng(13, StreamKind::other, 0);
  // Compton edge of 511 keV: an electron takes at most 2/3 of it.
  double most_keV = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const ComptonScattering scattering = sample_compton(oxygen, kElectronMass_keV, rng);
    CHECK(scattering.energy_keV ==
          doctest::Approx(compton_energy_keV(kElectronMass_keV, scattering.cosine)).epsilon(1e-12));
    most_keV = std::max(most_keV, kElectronMass_keV - scattering.energy_keV);
  }
  CHECK(most_keV <= kElectronMass_keV * 2.0 / 3.0 + 1e-9);
  CHECK(most_keV > kElectronMass_keV * 0.66);
}

TEST_CASE("Rayleigh angles follow the form factor") {
  const ElementData silicon(14);
  for (const double energy_keV : {12.0, 60.0}) {
    CAPTURE(energy_keV);
    Rng rng(14, StreamKind::other, static_cast<std::uint64_t>(energy_keV));
    CHECK(p_value([&] { return silicon.sample_rayleigh_cosine(energy_keV, rng); },
                  [&](double cosine) {
                    const double x = energy_keV * kPerAngstromPerkeV * half_sine(cosine);
                    return (1.0 + cosine * cosine) * std::pow(FF_Rayl(14, x, nullptr), 2);
                  }) > 1e-4);
  }
}
