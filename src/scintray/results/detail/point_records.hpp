#pragma once
/// Records of a point that some results files have.

#include <vector>

#include "scintray/core/h5.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::results::format {

/// Readers of a point's group that has the record. @throws std::invalid_argument for a contradiction
tally::LightTiming get_light_timing(const core::h5::Group& point);
std::vector<tally::OmittedEffect> get_omitted_effects(const core::h5::Group& point);
tally::UntilResult get_until(const core::h5::Group& point);
tally::EventFates get_event_fates(const core::h5::Group& point);

}  // namespace scintray::results::format
