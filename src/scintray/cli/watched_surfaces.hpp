#pragma once
/// Progress of the building of surface tables.

#include "scintray/cli/progress.hpp"
#include "scintray/materials/surface_factory.hpp"

namespace scintray::cli {

/// Hooks that show the progress of a table on the line, print warnings of the cache on standard error and
/// stop on Ctrl-C. The line must outlive them.
materials::SurfaceFactory::Hooks watched_surfaces(ProgressLine& line);

}  // namespace scintray::cli
