#pragma once
/// Many events, with what sensors see of them from a response map instead of from photons.

#include "scintray/simulation/mapped_response.hpp"
#include "scintray/simulation/run_point.hpp"

namespace scintray::simulation {

/// Events of a source of energy: the same deposits and numbers of photons, to the last bit, as run_point
/// makes with this seed. How many of them each channel detects is multinomial with the map's probabilities
/// at each deposit; times are those of the decay and of ways in the map. With a readout photons arrive
/// anywhere on the sensor's face. The result does not depend on the number of threads.
///
/// @return with events and no photons: none was traced
/// @param plan  of the same scene, without tallies
/// @throws InputError when energy is left in a scintillator that the map does not cover
tally::PointResult run_mapped(const scene::Scene& scene, const source::LightSource& source,
                              const tally::TallyPlan& plan, const MappedResponse& response,
                              const RunSettings& settings, const RunHooks& hooks = {});

}  // namespace scintray::simulation
