#include "scintray/source/detail/cherenkov.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/source/detail/gamma/element_data.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::source;

namespace {

Medium medium_of(const std::string& formula, double density_g_per_cm3, Curve index) {
  Medium medium;
  medium.name = formula;
  medium.composition = composition_of_formula(formula);
  medium.density_g_per_cm3 = density_g_per_cm3;
  medium.index = std::move(index);
  return medium;
}

Medium bgo(Curve index = Curve::constant(2.15)) { return medium_of("Bi4Ge3O12", 7.13, std::move(index)); }

double beta_squared(double energy_keV) {
  const double gamma = 1.0 + energy_keV / kElectronMass_keV;
  return 1.0 - 1.0 / (gamma * gamma);
}

std::string message_of(const Medium& medium, double low_nm, double high_nm) {
  try {
    CherenkovEmitter(medium, low_nm, high_nm);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Mean excitation energies of compounds are those of NIST's ESTAR") {
  // ESTAR's list of materials (physics.nist.gov/PhysRefData/Star): liquids and solids to which it assigns
  // its values by additivity.
  for (const auto& row : {std::pair{"Bi4Ge3O12", 534.1},
                          {"NaI", 452.0},
                          {"CsI", 553.1},
                          {"CdWO4", 468.3},
                          {"BaF2", 375.9},
                          {"CaWO4", 395.0}}) {
    const auto& formula = row.first;
    const auto& expected = row.second;
    CAPTURE(formula);
    const ElectronStopping stopping(composition_of_formula(formula), 5.0);
    CHECK(stopping.mean_excitation_eV() == doctest::Approx(expected).epsilon(5e-4));
  }
  CHECK(mean_excitation_eV(82, false) == 823.0);
  CHECK_THROWS_AS(mean_excitation_eV(93, false), InternalError);
}

TEST_CASE("Collision stopping power of water is that of NIST's ESTAR, and so is the range") {
  // ESTAR, liquid water: MeV cm2/g; it takes 75.0 eV, where additivity gives 75.3 eV.
  const ElectronStopping water(composition_of_formula("H2O"), 1.0);
  for (const auto& row : {std::pair{10.0, 22.56},
                          {60.0, 5.797},
                          {100.0, 4.115},
                          {200.0, 2.793},
                          {500.0, 2.034},
                          {1000.0, 1.849}}) {
    const auto& energy_keV = row.first;
    const auto& expected = row.second;
    CAPTURE(energy_keV);
    CHECK(water.MeV_cm2_per_g(energy_keV) == doctest::Approx(expected).epsilon(2e-3));
    CHECK(water.keV_per_mm(energy_keV) == doctest::Approx(100.0 * water.MeV_cm2_per_g(energy_keV)));
  }
}

TEST_CASE("Law: Cherenkov light begins where beta n = 1") {
  for (const double n : {1.33, 1.82, 2.15}) {
    const CherenkovEmitter emitter(bgo(Curve::constant(n)), 300.0, 800.0);
    CHECK(beta_squared(emitter.threshold_keV()) * n * n == doctest::Approx(1.0));
    CHECK(emitter.mean_photons(0.999 * emitter.threshold_keV()) == 0.0);
    CHECK(emitter.mean_photons(1.05 * emitter.threshold_keV()) > 0.0);
  }
  const CherenkovEmitter none(bgo(Curve::constant(1.0)), 300.0, 800.0);
  CHECK(none.mean_photons(9000.0) == 0.0);
}

TEST_CASE("Law: Frank and Tamm along the path of an electron that slows down") {
  // The same integral another way: Simpson over energy, for one index.
  constexpr double kLow = 310.0, kHigh = 750.0, kIndex = 2.15;
  const CherenkovEmitter emitter(bgo(), kLow, kHigh);
  const ElectronStopping stopping(bgo().composition, 7.13);
  const double per_mm = kTwoPi / 137.035999084 * (1.0 / kLow - 1.0 / kHigh) * 1e6;
  for (const double energy_keV : {100.0, 300.0, 511.0, 1200.0}) {
    const double from = emitter.threshold_keV();
    constexpr int kPanels = 2000;
    const double h = (energy_keV - from) / (2 * kPanels);
    const auto f = [&](double e) {
      return std::max(0.0, 1.0 - 1.0 / (beta_squared(e) * kIndex * kIndex)) / stopping.keV_per_mm(e);
    };
    double sum = f(from) + f(energy_keV);
    for (int i = 1; i < 2 * kPanels; ++i) sum += (i % 2 ? 4.0 : 2.0) * f(from + i * h);
    CAPTURE(energy_keV);
    CHECK(emitter.mean_photons(energy_keV) == doctest::Approx(per_mm * sum * h / 3.0).epsilon(1e-3));
  }
}

TEST_CASE(
    "Law: without dispersion Cherenkov light has 1 / wavelength^2, with it less where the index is low") {
  constexpr std::size_t kBins = 20;
  constexpr std::uint64_t kPhotons = 100'000;
  const auto histogram = [&](const CherenkovEmitter& emitter, double energy_keV) {
    std::vector<std::uint64_t> counts(kBins, 0);
    for (std::uint64_t i = 0; i < kPhotons; ++i) {
      Rng rng(31, StreamKind::other, i);
      const double nm = emitter.sample_wavelength(energy_keV, rng);
      ++counts.at(static_cast<std::size_t>((nm - 300.0) / 20.0));
    }
    return counts;
  };
  std::vector<double> expected;
  for (std::size_t i = 0; i < kBins; ++i) {
    const double low = 300.0 + 20.0 * static_cast<double>(i), high = low + 20.0;
    expected.push_back(kPhotons * (1.0 / low - 1.0 / high) / (1.0 / 300.0 - 1.0 / 700.0));
  }
  const CherenkovEmitter flat(bgo(), 300.0, 700.0);
  // False alarm once in 10,000.
  CHECK(chi_square_test(histogram(flat, 421.3), expected).p_value > 1e-4);

  // beta n = 1 at 90 keV (index 1.89) is reached at 500 nm: nothing beyond.
  const Curve falling({300.0, 700.0}, {2.4, 1.4});
  const CherenkovEmitter dispersive(bgo(falling), 300.0, 700.0);
  const double energy_keV = 90.0;
  const double end_nm = 300.0 + 400.0 * (2.4 - 1.0 / std::sqrt(beta_squared(energy_keV)));
  REQUIRE(end_nm < 600.0);
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Rng rng(37, StreamKind::other, i);
    CHECK(dispersive.sample_wavelength(energy_keV, rng) < end_nm + 8.0);  // a step of energy, of wavelength
  }
  Rng rng(37, StreamKind::other, 0);
  CHECK_THROWS_AS(dispersive.sample_wavelength(10.0, rng), InternalError);
}

TEST_CASE("BGO makes more Cherenkov light of 511 keV than LSO; the numbers are printed") {
  const MaterialDatabase database = MaterialDatabase::shipped();
  const CherenkovEmitter in_bgo(database.medium("BGO"), 360.0, 690.0),
      in_lso(database.medium("LSO"), 360.0, 690.0);
  for (const auto& row : {std::pair{"BGO", &in_bgo}, {"LSO", &in_lso}})
    MESSAGE(std::string(row.first) << ", 360 to 690 nm: threshold " << row.second->threshold_keV()
                                   << " keV, photons of 511 keV " << row.second->mean_photons(511.0)
                                   << ", of 420 keV " << row.second->mean_photons(420.0));
  CHECK(in_bgo.threshold_keV() < in_lso.threshold_keV());
  CHECK(in_bgo.mean_photons(511.0) > in_lso.mean_photons(511.0));
}

TEST_CASE("Media without the data for Cherenkov light are reported") {
  Medium unknown = bgo();
  unknown.composition.clear();
  CHECK(message_of(unknown, 300.0, 700.0).find("\"Bi4Ge3O12\" does not say what it is made of") !=
        std::string::npos);
  CHECK(message_of(bgo(), 700.0, 300.0).find("from 700 to 300 nm is asked for") != std::string::npos);
  CHECK(message_of(bgo(Curve({400.0, 600.0}, {2.2, 2.1})), 300.0, 700.0)
            .find("refractive indices from 400 to 600 nm, but Cherenkov light from 300 to 700 nm") !=
        std::string::npos);
}
