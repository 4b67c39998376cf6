#pragma once
/// What `scintray check` and `scintray run` say about a scene that can run.

#include <iosfwd>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::cli {

/// Warnings about parts that nearly touch, each with its place.
std::vector<core::Problem> gap_warnings(const simulation::SimulationPoint& point);

/// Prints notes on the scene and the source of a point, and on definitions of the scene file that nothing
/// uses.
void print_notes(std::ostream& out, const scene_file::SceneFile& file,
                 const simulation::SimulationPoint& point);

/// Prints one line for each warning; warnings that differ in numbers only share one, unless `every_one`.
void print_warnings(std::ostream& out, const std::vector<core::Problem>& warnings, bool every_one);

}  // namespace scintray::cli
