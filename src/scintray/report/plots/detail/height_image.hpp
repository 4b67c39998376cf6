#pragma once
/// Pictures of height maps.

#include <cstdint>
#include <string>

#include "scintray/topography/height_map.hpp"

namespace scintray::report {

/// Heights as colours (viridis, S. van der Walt and N. Smith 2015, CC0), from `low_um` to `high_um`,
/// missing points grey, as an <img> of PNG data of at most 600 pixels a side; larger maps show the
/// mean of the points under each pixel. `alternative` is read by screen readers.
std::string height_image(const topography::HeightMap& map, double low_um, double high_um,
                         const std::string& alternative);

/// A scale for it: the colours, labelled with the two heights.
std::string height_scale(double low_um, double high_um);

}  // namespace scintray::report
