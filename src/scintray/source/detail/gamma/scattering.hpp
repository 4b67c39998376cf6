#pragma once
/// Compton scattering.

#include "scintray/source/detail/gamma/element_data.hpp"

namespace scintray::source {

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
