#pragma once
/// Constants of nature that several modules need.

namespace scintray::core {

/// Rest energy of the electron, and energy of annihilation photons. CODATA 2018.
inline constexpr double kElectronMass_keV = 510.99895;

}  // namespace scintray::core
