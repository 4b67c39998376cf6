#pragma once
/// When one photon of a scene's events is detected, as far as the scene itself says it.

#include <optional>

#include "scintray/source/light_source.hpp"
#include "scintray/tally/result.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray {

/// Emission and time spread of the sensors, where all light of events has the same: one decay in all media
/// that scintillate, sensors of one time spread behind a readout, no Cherenkov light and no wavelength
/// shifter. Nothing otherwise.
std::optional<LightTiming> light_timing(const Scene& scene, const SceneSpec& spec, const LightSource& source,
                                        const TallyPlan& plan);

}  // namespace scintray
