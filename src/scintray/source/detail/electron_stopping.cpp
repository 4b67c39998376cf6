#include "scintray/source/detail/cherenkov.hpp"

#include <xraylib/xraylib.h>

#include <array>
#include <cmath>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/source/detail/gamma/element_data.hpp"

namespace scintray::source {

namespace {

/// Mean excitation energies of the elements, eV, by atomic number from 1.
constexpr std::array<double, optics::kGreatestAtomicNumber> kElements = {
    19.2,  41.8,  40.0,  63.7,  76.0,  78.0,  82.0,  95.0,  115.0, 137.0, 149.0, 156.0, 166.0, 173.0,
    173.0, 180.0, 174.0, 188.0, 190.0, 191.0, 216.0, 233.0, 245.0, 257.0, 272.0, 286.0, 297.0, 311.0,
    322.0, 330.0, 334.0, 350.0, 347.0, 348.0, 343.0, 352.0, 363.0, 366.0, 379.0, 393.0, 417.0, 424.0,
    428.0, 441.0, 449.0, 470.0, 470.0, 469.0, 488.0, 488.0, 487.0, 485.0, 491.0, 482.0, 488.0, 491.0,
    501.0, 523.0, 535.0, 546.0, 560.0, 574.0, 580.0, 591.0, 614.0, 628.0, 650.0, 658.0, 674.0, 684.0,
    694.0, 705.0, 718.0, 727.0, 736.0, 746.0, 757.0, 790.0, 790.0, 800.0, 810.0, 823.0, 823.0, 830.0,
    825.0, 794.0, 827.0, 826.0, 841.0, 847.0, 878.0, 890.0};

/// 2 pi r_e^2 m c^2 N_A, MeV cm2/mol (CODATA 2018).
constexpr double kBethe_MeV_cm2_per_mol = 0.5 * 0.307075;
/// Plasma energy of matter with one electron for each u and 1 g/cm3, eV.
constexpr double kPlasma_eV = 28.816;

}  // namespace

double mean_excitation_eV(int atomic_number, bool compound) {
  if (atomic_number < 1 || atomic_number > optics::kGreatestAtomicNumber)
    throw core::InternalError("no mean excitation energy of element " + std::to_string(atomic_number));
  const double element = kElements[static_cast<std::size_t>(atomic_number - 1)];
  if (!compound) return element;
  switch (atomic_number) {
    case 1:
      return 19.2;
    case 6:
      return 81.0;
    case 7:
      return 82.0;
    case 8:
      return 106.0;
    case 9:
      return 112.0;
    case 17:
      return 180.0;
    default:
      return 1.13 * element;
  }
}

ElectronStopping::ElectronStopping(const optics::Composition& composition, double density_g_per_cm3)
    : density_g_per_cm3_(density_g_per_cm3) {
  if (composition.empty() || !(density_g_per_cm3 > 0.0))
    throw core::InternalError("stopping power of a material without composition or density");
  double logarithm = 0.0;
  for (const optics::ElementShare& share : composition) {
    const double electrons =
        share.mass_fraction * share.atomic_number / AtomicWeight(share.atomic_number, nullptr);
    electrons_per_u_ += electrons;
    logarithm += electrons *
                 std::log(scintray::source::mean_excitation_eV(share.atomic_number, composition.size() > 1));
  }
  mean_excitation_eV_ = std::exp(logarithm / electrons_per_u_);

  const double plasma_eV = kPlasma_eV * std::sqrt(density_g_per_cm3 * electrons_per_u_);
  c_ = -2.0 * std::log(mean_excitation_eV_ / plasma_eV) - 1.0;
  const bool low = mean_excitation_eV_ < 100.0;
  x1_ = low ? 2.0 : 3.0;
  x0_ = -c_ < (low ? 3.681 : 5.215) ? 0.2 : -0.326 * c_ - (low ? 1.0 : 1.5);
  a_ = -(c_ + 2.0 * std::log(10.0) * x0_) / std::pow(x1_ - x0_, 3);
}

double ElectronStopping::density_effect(double beta_gamma) const {
  const double x = std::log10(beta_gamma);
  if (x < x0_) return 0.0;
  const double high = 2.0 * std::log(10.0) * x + c_;
  return x < x1_ ? high + a_ * std::pow(x1_ - x, 3) : high;
}

double ElectronStopping::MeV_cm2_per_g(double energy_keV) const {
  const double tau = energy_keV / core::kElectronMass_keV;
  const double gamma2 = (tau + 1.0) * (tau + 1.0);
  const double beta2 = tau * (tau + 2.0) / gamma2;
  const double f = (1.0 - beta2) * (1.0 + tau * tau / 8.0 - (2.0 * tau + 1.0) * std::log(2.0));
  const double ratio = 1e3 * energy_keV / mean_excitation_eV_;
  const double number =
      2.0 * std::log(ratio) + std::log(1.0 + 0.5 * tau) + f - density_effect(std::sqrt(tau * (tau + 2.0)));
  return kBethe_MeV_cm2_per_mol * electrons_per_u_ / beta2 * number;
}

double ElectronStopping::keV_per_mm(double energy_keV) const {
  constexpr double kKeV_per_mm = 100.0;  // of 1 MeV/cm
  return kKeV_per_mm * density_g_per_cm3_ * MeV_cm2_per_g(energy_keV);
}

}  // namespace scintray::source
