#pragma once

#include <CLI/App.hpp>

namespace scintray::cli {

/// Adds `export` to `scintray table`: writes a surface table for other programs.
void add_table_export_command(CLI::App& table);

}  // namespace scintray::cli
