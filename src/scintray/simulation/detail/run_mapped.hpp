#pragma once
/// Events whose signals are computed from a response map instead of from photons.

#include "scintray/simulation/mapped_response.hpp"
#include "scintray/simulation/run_point.hpp"

namespace scintray::simulation {

/// Events of an event source: the same deposits and numbers of photons, to the last bit, as run_point
/// produces with this seed. The number of them that each channel detects is multinomial with the map's
/// probabilities at each deposit; times are the sum of the decay time and a delay of the map. With a readout,
/// photons arrive anywhere on the sensor's face. The result does not depend on the number of threads.
///
/// @return a result with events and without photons, since none was traced
/// @param plan  of the same scene, without tallies
/// @throws InputError when energy is deposited in a scintillator that the map does not cover
tally::PointResult run_mapped(const scene::Scene& scene, const source::LightSource& source,
                              const tally::TallyPlan& plan, const MappedResponse& response,
                              const RunSettings& settings, const RunHooks& hooks = {});

}  // namespace scintray::simulation
