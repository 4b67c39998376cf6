#pragma once
/// Attenuation of gammas of 10 keV to 3 MeV in matter: cross sections, and Compton scattering.

#include <memory>
#include <vector>

#include "scintray/optics/composition.hpp"
#include "scintray/source/detail/gamma/element_data.hpp"

namespace scintray::source {

/// The next interaction of a gamma.
struct GammaEncounter {
  GammaProcess process = GammaProcess::photoelectric;
  const ElementData* element = nullptr;
};

/// Cross sections of a compound or mixture: sums over its elements by mass (Bragg's additivity rule,
/// J. H. Hubbell and S. M. Seltzer 1995, NISTIR 5632, eq. 6). Immutable.
///
/// They are tabulated at 200 energies per decade and on both sides of every absorption edge, with linear
/// interpolation in energy.
class GammaMatter {
 public:
  GammaMatter(const optics::Composition& composition, double density_g_per_cm3);

  /// Linear attenuation coefficient (1/mm), in total and by process.
  double total_per_mm(double energy_keV) const;
  double per_mm(GammaProcess process, double energy_keV) const;

  /// Process and element of an interaction, drawn at random.
  GammaEncounter sample(double energy_keV, core::Rng& rng) const;

 private:
  struct Position {
    std::size_t row;
    double t;  ///< relative position towards the next row
  };
  Position position(double energy_keV) const;
  double at(const Position& position, std::size_t channel) const;
  void make_energies();

  std::vector<std::shared_ptr<const ElementData>> elements_;
  std::vector<double> energies_keV_;
  std::vector<double> total_;    ///< per energy, 1/mm
  std::vector<double> channel_;  ///< [energy][element][process], 1/mm
};

struct ComptonScattering {
  double cosine = 1.0;      ///< of the scattering angle
  double energy_keV = 0.0;  ///< of the scattered gamma
};

/// Energy of a gamma scattered by a free electron at rest (A. H. Compton 1923, Phys. Rev. 21 483, eq. 5).
inline double compton_energy_keV(double energy_keV, double cosine) {
  return energy_keV / (1.0 + energy_keV / core::kElectronMass_keV * (1.0 - cosine));
}

/// Scattering of an unpolarised gamma by a free electron (O. Klein and Y. Nishina 1929, Z. Phys. 52 853),
/// by composition and rejection (J. C. Butcher and H. Messel 1960, Nucl. Phys. 20 15).
ComptonScattering sample_klein_nishina(double energy_keV, core::Rng& rng);

/// Compton scattering of an unpolarised gamma by an atom: angles are accepted with the incoherent scattering
/// function, which suppresses forward scattering by bound electrons. Doppler broadening of the energy is not
/// included.
ComptonScattering sample_compton(const ElementData& element, double energy_keV, core::Rng& rng);

}  // namespace scintray::source
