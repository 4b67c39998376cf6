#pragma once
/// Text about a height map.

#include "scintray/cli/json_answer.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::cli {

/// Summary: size and history, heights and slopes, in a few lines.
void print_summary(const topography::HeightMap& map);

/// Lengths and directions, the distribution of slopes, visible slopes against incidence (when no point
/// is missing), after the summary.
void print_description(const topography::HeightMap& map);

/// The numbers of a map and its warnings, with the units in their names.
Json map_json(const topography::HeightMap& map);

/// The warnings of map_warnings, one a line.
void print_warnings(const topography::HeightMap& map);

/// Mean visible slope against incidence, from both sides.
void print_visible_slopes(const optics::HeightField& field);

}  // namespace scintray::cli
