#pragma once

#include <CLI/App.hpp>

namespace scintray::cli {

/// Adds `scintray table build | show`: surface tables from height maps, and what is in them.
void add_table_command(CLI::App& app);

}  // namespace scintray::cli
