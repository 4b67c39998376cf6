#include "scintray/source/detail/gamma/decay.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/source/detail/gamma/element_data.hpp"

namespace scintray::source {

namespace {

constexpr double kReducedComptonWavelength_fm = 386.15926796;  // CODATA 2018
constexpr int kSpectrumPoints = 401;

/// Logarithm of the gamma function for a positive real part: the recurrence up to where Stirling's series
/// (Abramowitz and Stegun, eq. 6.1.40) is accurate to 1e-12.
std::complex<double> log_gamma(std::complex<double> z) {
  std::complex<double> below = 0.0;
  while (z.real() < 12.0) {
    below += std::log(z);
    z += 1.0;
  }
  const std::complex<double> inverse = 1.0 / z, square = inverse * inverse;
  return (z - 0.5) * std::log(z) - z + 0.5 * std::log(core::kTwoPi) +
         inverse * (1.0 / 12.0 - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square / 1680.0))) - below;
}

/// Fermi function up to a constant factor.
double fermi(double momentum, double energy, double z, double radius) {
  const double gamma = std::sqrt(1.0 - std::pow(kFineStructure * z, 2));
  const double eta = kFineStructure * z * energy / momentum;
  return std::pow(2.0 * momentum * radius, 2.0 * gamma - 2.0) *
         std::exp(core::kPi * eta + 2.0 * log_gamma({gamma, eta}).real());
}

}  // namespace

core::Curve beta_spectrum(double end_keV, int daughter_atomic_number, int mass_number) {
  const double radius = 1.2 * std::cbrt(mass_number) / kReducedComptonWavelength_fm;
  std::vector<double> kinetic_keV, number;
  for (int i = 0; i < kSpectrumPoints; ++i) {
    // At rest p and the pole of the Fermi function cancel: a slightly larger energy has the same limit.
    const double t = std::max(1e-6, static_cast<double>(i) / (kSpectrumPoints - 1));
    const double energy = 1.0 + t * end_keV / core::kElectronMass_keV;
    const double momentum = std::sqrt(energy * energy - 1.0);
    kinetic_keV.push_back(t * end_keV);
    number.push_back(fermi(momentum, energy, daughter_atomic_number, radius) * momentum * energy *
                     std::pow(1.0 - t, 2));
  }
  return {std::move(kinetic_keV), std::move(number)};
}

DecaySampler::DecaySampler(scene_file::Emission emission) : emission_(emission) {
  if (emission == scene_file::Emission::lutetium)
    beta_ = core::CurveSampler(beta_spectrum(kLutetiumBetaEnd_keV, 72, 176));
}

Emitted DecaySampler::sample(core::Rng& rng) const {
  Emitted emitted;
  switch (emission_) {
    case scene_file::Emission::gamma:
      break;
    case scene_file::Emission::pair:
      emitted.pair = true;
      break;
    case scene_file::Emission::caesium:
      if (rng.uniform() < kCaesiumGammas) emitted.gammas_keV.push_back(kCaesiumGamma_keV);
      break;
    case scene_file::Emission::sodium:
      if (rng.uniform() < kSodiumGammas) emitted.gammas_keV.push_back(kSodiumGamma_keV);
      emitted.pair = rng.uniform() < kSodiumPositrons;
      break;
    case scene_file::Emission::lutetium:
      emitted.electrons_keV.push_back(beta_.sample(rng.uniform()));
      for (const LutetiumTransition& transition : kLutetiumTransitions)
        if (rng.uniform() < transition.gammas)
          emitted.gammas_keV.push_back(transition.energy_keV);
        else
          emitted.electrons_keV.push_back(transition.energy_keV);
      break;
  }
  return emitted;
}

}  // namespace scintray::source
