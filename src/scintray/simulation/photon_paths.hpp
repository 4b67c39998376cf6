#pragma once
/// Paths of single photons of a run, for pictures.

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/simulation/simulation_point.hpp"
#include "scintray/tally/photon_path.hpp"

namespace scintray::simulation {

/// A step event in words, with the names of what it happened at.
std::string step_text(const scene::Scene& scene, const transport::Step& step);

/// Paths of the first `count` photons, as the run with the same seed traces them; of an event source, of
/// photons equally spaced in each of its first events with light, at most ten. Fewer where the source
/// has fewer. The path of a photon that escapes ends a tenth of the scene's diagonal beyond its last
/// boundary; one with more than tally::kMostPathSteps steps lacks those before its last.
/// @param stop  ends the list early when it is set; may be null
std::vector<tally::PhotonPath> photon_paths(const SimulationPoint& point, std::uint64_t count,
                                            const std::atomic<bool>* stop = nullptr);

}  // namespace scintray::simulation
