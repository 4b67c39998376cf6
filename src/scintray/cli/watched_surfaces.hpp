#pragma once
/// Surface tables built while someone waits.

#include "scintray/cli/progress.hpp"
#include "scintray/materials/surface_factory.hpp"

namespace scintray::cli {

/// Shows on the line how far a table is, and gives up on Ctrl-C. The line must live longer.
materials::SurfaceFactory::Hooks watched_surfaces(ProgressLine& line);

}  // namespace scintray::cli
