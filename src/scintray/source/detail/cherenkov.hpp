#pragma once
/// Cherenkov light of electrons that stop in a medium, and their stopping power.

#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/optics/composition.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/source/event.hpp"

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

  /// Collision stopping power, keV/mm.
  double keV_per_mm(double energy_keV) const;
  /// Mass collision stopping power, MeV cm2/g, as published in tables.
  double MeV_cm2_per_g(double energy_keV) const;
  double mean_excitation_eV() const { return mean_excitation_eV_; }

 private:
  double density_effect(double beta_gamma) const;

  double density_g_per_cm3_;
  double electrons_per_u_ = 0.0;     ///< sum of mass fraction times Z / A
  double mean_excitation_eV_ = 0.0;  ///< of the material
  // Sternheimer and Peierls' constants: delta = 2 ln(10) x + c + a (x1 - x)^3 between x0 and x1.
  double c_ = 0.0, a_ = 0.0, x0_ = 0.0, x1_ = 0.0;
};

/// Throws InputError (without a place) for an index that does not cover the wavelengths of Cherenkov light,
/// and for wavelengths that are not 0 < low < high.
void check_cherenkov_range(const optics::Medium& medium, double low_nm, double high_nm);

/// Number and spectrum of the Cherenkov photons of an electron that slows down to rest.
///
/// I. Frank and I. Tamm's formula, photons per path and wavelength 2 pi alpha (1 - 1 / (beta
/// n)^2) / wavelength^2 (Particle Data Group, Review of Particle Physics, section on Cherenkov radiation),
/// along the path of an electron that slows down continuously by collisions (ElectronStopping). Not included:
/// bremsstrahlung, which shortens the path of an electron of 511 keV in lutetium or lead by some per cent,
/// delta electrons, and energy straggling. Tabulated at construction. Immutable.
class CherenkovEmitter {
 public:
  /// Largest tabulated energy; above it the number of photons is constant.
  static constexpr double kGreatestEnergy_keV = 10'000.0;

  /// Photons of low_nm to high_nm only: the index, and therefore the emission, is limited to the medium's
  /// table.
  /// @throws InputError (without a place) for a medium without composition, an index that does not cover the
  ///         wavelengths, and wavelengths that are not 0 < low < high
  CherenkovEmitter(const optics::Medium& medium, double low_nm, double high_nm);

  /// Threshold kinetic energy of Cherenkov emission at any wavelength: beta n = 1 at the greatest index.
  /// Above kGreatestEnergy_keV when there is no emission up to that energy.
  double threshold_keV() const { return threshold_keV_; }

  /// Mean number of photons of one electron. Apart from energy straggling the number is Poisson distributed.
  double mean_photons(double energy_keV) const;
  /// Wavelength (nm) of one of these photons, drawn at random. Throws InternalError at an energy without
  /// emission.
  double sample_wavelength(double energy_keV, core::Rng& rng) const;

 private:
  struct Place {
    std::size_t node = 0;  ///< the lower one
    double share = 0.0;    ///< relative position towards the next node
  };
  Place place(double energy_keV) const;

  double threshold_keV_ = 0.0;
  std::vector<double> energies_keV_, photons_;              ///< from the threshold on
  std::vector<std::optional<core::CurveSampler>> spectra_;  ///< nothing where there are no photons
};

/// Cherenkov photons of a charged particle along a straight step in a medium.
///
/// Frank and Tamm's formula as of CherenkovEmitter, times the square of the charge; directions on the cone of
/// cosine 1 / (beta n) about the step, polarised in the plane of the two (J. V. Jelley 1958, Cerenkov
/// radiation, cited as in Geant4's G4Cerenkov, whose steps these are). The velocity changes linearly along
/// the step. Immutable.
class CherenkovTrack {
 public:
  /// Photons of low_nm to high_nm only. Throws InputError as CherenkovEmitter does, but needs no composition.
  CherenkovTrack(const optics::Medium& medium, double low_nm, double high_nm);

  /// Mean number of photons per mm of a particle of charge 1 with a velocity beta (over that in vacuum).
  double per_mm(double beta) const;
  /// Mean number of photons of a step.
  double mean_photons(const ParticleStep& step) const;

  /// A photon of a step: where along it (0 start, 1 end), its wavelength, direction and polarisation.
  struct Emission {
    double along = 0.0, wavelength_nm = 0.0;
    core::Vec3 direction = core::Vec3::UnitZ(), polarisation = core::Vec3::UnitX();
  };
  /// Draws a photon. Throws InputError for a step that is slower than light in the medium all along.
  Emission sample(const ParticleStep& step, core::Rng& rng) const;

 private:
  core::Curve index_;
  double low_nm_, high_nm_, greatest_index_;
  core::Curve per_mm_;  ///< against beta
};

}  // namespace scintray::source
