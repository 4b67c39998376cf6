#pragma once
/// `scintray table`: surface tables made, and what is in them.

#include <CLI/App.hpp>

namespace scintray::cli {

void add_table_command(CLI::App& app);

/// Its subcommands, each in a file of its own.
void add_table_build_command(CLI::App& table);
void add_table_stack_command(CLI::App& table);
void add_table_show_command(CLI::App& table);
void add_table_export_command(CLI::App& table);
void add_table_import_command(CLI::App& table);
void add_table_list_command(CLI::App& table);
void add_table_compare_command(CLI::App& table);

}  // namespace scintray::cli
