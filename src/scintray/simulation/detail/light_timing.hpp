#pragma once
/// When one photon of a scene's events is detected, as far as the scene itself states it.

#include <optional>

#include "scintray/source/light_source.hpp"
#include "scintray/tally/result.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray::simulation {

/// Emission and time spread of the sensors, where all light of events has the same: one decay in all media
/// that scintillate, sensors of one time spread behind a readout, no Cherenkov light and no wavelength
/// shifter. Nothing otherwise.
std::optional<tally::LightTiming> light_timing(const scene::Scene& scene, const scene_file::SceneSpec& spec,
                                               const source::LightSource& source,
                                               const tally::TallyPlan& plan);

}  // namespace scintray::simulation
