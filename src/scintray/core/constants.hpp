#pragma once
/// Physical constants that several modules use.

namespace scintray::core {

/// Rest energy of the electron, and energy of annihilation photons. CODATA 2018.
inline constexpr double kElectronMass_keV = 510.99895;

}  // namespace scintray::core
