#include "scintray/cli/table_command.hpp"

#include "scintray/cli/map_command.hpp"

namespace scintray::cli {

void add_table_command(CLI::App& app) {
  CLI::App* table = app.add_subcommand("table", "Surface tables, and the surfaces of the library");
  table->require_subcommand(1);
  add_table_list_command(*table);
  add_table_compare_command(*table);
  add_table_build_command(*table);
  add_table_stack_command(*table);
  add_table_show_command(*table);
  add_table_export_command(*table);
  add_table_import_command(*table);
  add_map_synthesize_command(*table);  // the same as under `map`, where a table starts from no measurement
}

}  // namespace scintray::cli
