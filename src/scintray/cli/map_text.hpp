#pragma once
/// What the program prints about a height map.

#include "scintray/topography/height_map.hpp"

namespace scintray::cli {

/// Size and history, heights and slopes, in a few lines.
void print_summary(const topography::HeightMap& map);

/// Lengths and directions, the distribution of slopes, visible slopes against incidence (when no point
/// is missing), after the summary.
void print_description(const topography::HeightMap& map);

/// The warnings of map_warnings, each on a line.
void print_warnings(const topography::HeightMap& map);

/// Mean visible slope by a beam against its incidence, from both sides.
void print_visible_slopes(const optics::HeightField& field);

}  // namespace scintray::cli
