#pragma once
/// Cherenkov light of electrons that stop in a medium, and how they lose their energy there.

#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/optics/composition.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::source {

/// Mean excitation energy (eV) of the atoms of one element bound in a solid or liquid: M. J. Berger and
/// S. M. Seltzer 1982, NBSIR 82-2550 (the values of NIST's ESTAR and of ICRU Report 37): the element's own,
/// and of compounds their assignment scheme (ICRU 37, table 5.1): H 19.2, C 81, N 82, O 106, F 112, Cl 180,
/// of all other atoms 1.13 times the element's.
/// @param compound  false for a material of this element alone
double mean_excitation_eV(int atomic_number, bool compound);

/// Collision stopping power of a condensed material for electrons, 10 keV to 10 MeV.
///
/// Bethe's formula with Moller's cross section (ICRU 37, eqs. 2.12 and 2.13), Bragg's additivity for the
/// mean excitation energy, and the density effect by the general formula of R. M. Sternheimer and
/// R. F. Peierls 1971, Phys. Rev. B 3 3681. No shell correction. ESTAR's own uncertainty is 1 to 2 % above
/// 100 keV. Immutable.
class ElectronStopping {
 public:
  /// @param composition        not empty
  /// @param density_g_per_cm3  positive
  ElectronStopping(const optics::Composition& composition, double density_g_per_cm3);

  /// Energy lost per path, keV/mm.
  double keV_per_mm(double energy_keV) const;
  /// The same over the density, MeV cm2/g, as tables give it.
  double MeV_cm2_per_g(double energy_keV) const;
  double mean_excitation_eV() const { return mean_excitation_eV_; }

 private:
  double density_effect(double beta_gamma) const;

  double density_g_per_cm3_;
  double electrons_per_u_ = 0.0;     ///< sum of mass fraction times Z / A
  double mean_excitation_eV_ = 0.0;  ///< of the whole
  // Sternheimer and Peierls' constants: delta = 2 ln(10) x + c + a (x1 - x)^3 between x0 and x1.
  double c_ = 0.0, a_ = 0.0, x0_ = 0.0, x1_ = 0.0;
};

/// Number and spectrum of the photons that an electron makes on its way from its energy to rest.
///
/// I. Frank and I. Tamm's formula, photons per path and wavelength 2 pi alpha (1 - 1 / (beta n)^2) /
/// wavelength^2 (Particle Data Group, Review of Particle Physics, section on Cherenkov radiation), along the
/// path of an electron that slows down continuously by collisions (ElectronStopping). Left out:
/// bremsstrahlung, which makes the path of an electron of 511 keV in lutetium or lead some per cent shorter,
/// the electrons that it knocks on, and the spread of its losses. Tabulated when made, cheap to call.
/// Immutable.
class CherenkovEmitter {
 public:
  /// Energies are tabulated up to this; of more energy as many photons come as of this.
  static constexpr double kGreatestEnergy_keV = 10'000.0;

  /// Photons of low_nm to high_nm only: index, and so emission, ends where the medium's table ends.
  /// @throws InputError (no place) for a medium without composition, an index that does not cover the
  ///         wavelengths, and wavelengths that are not 0 < low < high
  CherenkovEmitter(const optics::Medium& medium, double low_nm, double high_nm);

  /// Kinetic energy above which an electron makes light of some wavelength: beta n = 1 at the greatest
  /// index. More than kGreatestEnergy_keV when none is known to.
  double threshold_keV() const { return threshold_keV_; }

  /// Photons expected of one electron. Their number is Poisson distributed about this, but for the spread of
  /// losses.
  double mean_photons(double energy_keV) const;
  /// A wavelength (nm) of them. InternalError at an energy that makes none.
  double sample_wavelength(double energy_keV, core::Rng& rng) const;

 private:
  struct Place {
    std::size_t node = 0;  ///< the lower one
    double share = 0.0;    ///< of the way to the next
  };
  Place place(double energy_keV) const;

  double threshold_keV_ = 0.0;
  std::vector<double> energies_keV_, photons_;              ///< from the threshold on
  std::vector<std::optional<core::CurveSampler>> spectra_;  ///< nothing where there are no photons
};

}  // namespace scintray::source
