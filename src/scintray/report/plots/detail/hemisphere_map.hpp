#pragma once
/// Pictures of directions over a hemisphere.

#include <cstdint>
#include <string>

#include "scintray/analysis/goniometer/hemisphere.hpp"

namespace scintray::report {

/// The hemisphere projected along its normal: distance from the centre is the polar angle (circles at 30, 60
/// and 90 deg), forward is to the right. Colours (viridis) are the logarithm of the density per sr over three
/// decades up to the largest of the map; cells with less, or without light, have the lowest colour.
///
/// @param mark_rad  polar angle, forward, of a cross, the direction of light from a flat face; below 0: none
/// @return an SVG element that contains a PNG picture, and the scale below it as HTML
std::string hemisphere_map(const analysis::DirectionCounts& counts, std::uint64_t rays, double mark_rad,
                           const std::string& alternative);

/// CSS of these pictures, for a page with the colours of html_page or of a report.
std::string hemisphere_map_style();

}  // namespace scintray::report
