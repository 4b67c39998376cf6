#pragma once

#include <CLI/App.hpp>

namespace scintray::cli {

/// Adds `scintray table build | show | synthesize`: surface tables from height maps, what is in
/// them, and height maps from recipes.
void add_table_command(CLI::App& app);

}  // namespace scintray::cli
