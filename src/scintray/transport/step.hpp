#pragma once
/// One step of one photon.

#include "scintray/core/philox.hpp"
#include "scintray/source/photon_records.hpp"
#include "scintray/transport/propagate.hpp"

namespace scintray::transport {

/// Moves the photon to its next event - bulk absorption, bulk scattering, or a boundary - and lets it
/// happen. Depends on nothing but its arguments.
/// @param records  side tables of the photon; null: nothing is recorded
Step step(const scene::Scene& scene, source::Photon& photon, core::Rng& rng,
          const PropagationLimits& limits = {}, source::PhotonRecords* records = nullptr);

}  // namespace scintray::transport
