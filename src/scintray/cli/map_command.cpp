#include <CLI/CLI.hpp>

#include "scintray/cli/commands.hpp"

namespace scintray::cli {

void add_map_command(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "Height maps of surfaces");
  map->require_subcommand(1);
  map->footer("Example: scintray map synthesize ground -o ground.gsf");
  for (const AddCommand add : map_commands()) add(*map);
}

}  // namespace scintray::cli
