#pragma once
/// A response map as text and as JSON.

#include "scintray/cli/json_answer.hpp"
#include "scintray/simulation/response_map.hpp"

namespace scintray::cli {

/// Direction, photons and grids of a map, with means over its cells.
Json json_of_map(const simulation::ResponseMap& map);

/// Prints the same to standard output.
void print_map(const simulation::ResponseMap& map);

}  // namespace scintray::cli
