#pragma once

#include <CLI/App.hpp>

namespace scintray::cli {

/// Adds `scintray table build | show`: surface tables from height maps, and what is in them.
void add_table_command(CLI::App& app);
void add_table_compare_command(CLI::App& table);
void add_table_list_command(CLI::App& table);

}  // namespace scintray::cli
