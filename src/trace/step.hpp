#pragma once
/// One step of one photon.

#include "scintray/core/philox.hpp"
#include "scintray/source/photon.hpp"
#include "scintray/tally/step.hpp"

namespace scintray {

/// Moves the photon to its next event - bulk absorption, bulk scattering, or a boundary - and lets it
/// happen. Depends on nothing but its arguments. Time advances with the group velocity.
Step step(const Scene& scene, Photon& photon, Rng& rng);

}  // namespace scintray
