#pragma once
/// The cells of a response map by light traced backward.

#include "scintray/simulation/response_map.hpp"
#include "scintray/tally/readout_channels.hpp"

namespace scintray::simulation {

/// Fills the empty grids of a map, whose settings, channels and photons_per_channel are set.
/// @return false when stopped
bool trace_backward(const scene::Scene& scene, const tally::ReadoutChannels& channels, const RunSettings& run,
                    const ResponseHooks& hooks, ResponseMap& map);

}  // namespace scintray::simulation
