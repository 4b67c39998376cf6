#pragma once
/// The scene of a run in three dimensions, for pages.

#include <filesystem>
#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/report/view/view_page.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::cli {

/// Parts of a scene for a view, which refers to the meshes without copying them.
std::vector<report::ViewPart> view_parts(const std::vector<contact::PlacedMesh>& placed);

/// The scene of results, built from the scene file in them: the placed parts, with the recorded paths of the
/// first point.
struct SceneOfResults {
  std::vector<contact::PlacedMesh> placed;  ///< to whose meshes `view` points
  report::RunView view;                     ///< without a view, but a reason, where meshes are not available
};
SceneOfResults scene_of_results(const std::filesystem::path& results, const tally::RunResult& run);

}  // namespace scintray::cli
