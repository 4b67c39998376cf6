#pragma once
/// Cherenkov light of electrons that stop in a medium.

#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::source {

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
