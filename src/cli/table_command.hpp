#pragma once

#include <CLI/App.hpp>

namespace scintray::cli {

/// Adds `scintray table build | show | synthesize | export | import`: surface tables from height maps, what
/// is in them, height maps from recipes, and exchange with other programs.
void add_table_command(CLI::App& app);

}  // namespace scintray::cli
