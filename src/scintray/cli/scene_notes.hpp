#pragma once
/// What `scintray check` and `scintray run` say about a scene that can run.

#include <iosfwd>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::cli {

/// Parts that nearly touch.
struct GapFindings {
  /// Gaps that may be mistakes: one for all between parts of the same two patterns, or for each, the one with
  /// the largest area first; with the places of its gaps.
  std::vector<core::Problem> warnings;
  /// Gaps that a builder left between its own parts, and those of [[gap]], one text for each pair of
  /// patterns; and each [[gap]] that no gap is of.
  std::vector<std::string> intended;
};
/// @param every_one  a warning for each gap
GapFindings find_gaps(const simulation::SimulationPoint& point, bool every_one = false);

/// Prints notes on the scene and the source of a point, and on definitions of the scene file that nothing
/// uses.
void print_notes(std::ostream& out, const scene_file::SceneFile& file,
                 const simulation::SimulationPoint& point);

/// Prints the findings, warnings with their numbers: those of the marks of a picture.
void print_gaps(std::ostream& out, const GapFindings& gaps);

}  // namespace scintray::cli
