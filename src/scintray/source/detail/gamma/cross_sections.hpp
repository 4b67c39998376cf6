#pragma once
/// Matter as gammas of 10 keV to 3 MeV see it: cross sections, and Compton scattering.

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
/// They are tabulated at 200 energies a decade and on both sides of every absorption edge, and linear in
/// the energy between.
class GammaMatter {
 public:
  GammaMatter(const optics::Composition& composition, double density_g_per_cm3);

  /// Interactions per mm, all together, and by process.
  double total_per_mm(double energy_keV) const;
  double per_mm(GammaProcess process, double energy_keV) const;

  /// Draws the process and the element of an interaction.
  GammaEncounter sample(double energy_keV, core::Rng& rng) const;

 private:
  struct Position {
    std::size_t row;
    double t;  ///< from that row to the next
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
  double cosine = 1.0;      ///< of the angle
  double energy_keV = 0.0;  ///< of the gamma afterwards
};

/// Energy of a gamma scattered by a free electron at rest (A. H. Compton 1923, Phys. Rev. 21 483, eq. 5).
inline double compton_energy_keV(double energy_keV, double cosine) {
  return energy_keV / (1.0 + energy_keV / core::kElectronMass_keV * (1.0 - cosine));
}

/// Scattering of an unpolarised gamma by a free electron (O. Klein and Y. Nishina 1929, Z. Phys. 52 853),
/// by composition and rejection (J. C. Butcher and H. Messel 1960, Nucl. Phys. 20 15).
ComptonScattering sample_klein_nishina(double energy_keV, core::Rng& rng);

/// The same by an atom: angles are kept with the incoherent scattering function, which takes forward
/// scattering from bound electrons. The electron's motion does not blur the energy.
ComptonScattering sample_compton(const ElementData& element, double energy_keV, core::Rng& rng);

}  // namespace scintray::source
