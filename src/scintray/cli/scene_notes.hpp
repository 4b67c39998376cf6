#pragma once
/// Notes and warnings of `scintray check` and `scintray run` on a scene that can run.

#include <iosfwd>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::cli {

/// Parts that nearly touch.
struct GapFindings {
  /// Gaps that may be unintended, with their places, the largest area first: one warning for all between
  /// parts of the same two patterns, or one for each.
  std::vector<core::Problem> warnings;
  /// Gaps that a builder leaves between its own parts, and those of [[gap]], one text for each pair of
  /// patterns; and each [[gap]] that matches no gap.
  std::vector<std::string> intended;
};
/// @param every_one  a warning for each gap
GapFindings find_gaps(const simulation::SimulationPoint& point, bool every_one = false);

/// Prints notes on the scene and the source of a point, and on unused definitions of the scene
/// file.
void print_notes(std::ostream& out, const scene_file::SceneFile& file,
                 const simulation::SimulationPoint& point);

/// Prints the findings, warnings with their numbers: those of the marks of a picture.
void print_gaps(std::ostream& out, const GapFindings& gaps);

}  // namespace scintray::cli
