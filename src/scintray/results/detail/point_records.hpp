#pragma once
/// Records of a point that some results files have.

#include <string>
#include <vector>

#include "scintray/core/h5.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::results::format {

/// Readers of a point's group that has the record. @throws std::invalid_argument for a contradiction
tally::LightTiming get_light_timing(const core::h5::Group& point);
std::vector<tally::OmittedEffect> get_omitted_effects(const core::h5::Group& point);
tally::UntilResult get_until(const core::h5::Group& point);
tally::EventFates get_event_fates(const core::h5::Group& point);

/// Sums over events of photons at `size` places, "NAME_event_squares" and "NAME_event_products"; empty in
/// files without them. @throws std::invalid_argument when their number is another
std::vector<tally::EventShare> get_event_shares(const core::h5::Group& point, const std::string& name,
                                                std::size_t size);

}  // namespace scintray::results::format
