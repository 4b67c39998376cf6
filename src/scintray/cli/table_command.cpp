#include <CLI/CLI.hpp>

#include "scintray/cli/commands.hpp"

namespace scintray::cli {

void add_table_command(CLI::App& app) {
  CLI::App* table = app.add_subcommand("table", "Surface tables, and the surfaces of the material database");
  table->require_subcommand(1);
  table->footer("Example: scintray table list");
  for (const AddCommand add : table_commands()) add(*table);
}

}  // namespace scintray::cli
