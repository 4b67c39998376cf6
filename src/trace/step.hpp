#pragma once
/// One step of one photon.

#include "scintray/core/philox.hpp"
#include "scintray/source/photon_records.hpp"
#include "scintray/trace/flight.hpp"

namespace scintray {

/// Moves the photon to its next event - bulk absorption, bulk scattering, or a boundary - and lets it
/// happen. Depends on nothing but its arguments.
/// @param records  side tables of the photon; null: nothing is recorded
Step step(const Scene& scene, Photon& photon, Rng& rng, const FlightLimits& limits = {},
          PhotonRecords* records = nullptr);

}  // namespace scintray
