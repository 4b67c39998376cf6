#pragma once
/// The data of a scene in three dimensions, as scene_view.js reads them.

#include <string>

#include "scintray/report/view/view_page.hpp"

namespace scintray::report {

/// JSON for a script element.
/// @param run  whose first point has the counts that are shown of parts and faces; may be null
std::string view_data(const SceneView& view, const tally::RunResult* run);

}  // namespace scintray::report
