#pragma once
/// How electrons lose energy to the electrons of matter.

#include <vector>

#include "scintray/optics/composition.hpp"

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

}  // namespace scintray::source
