#include "scintray/cli/map_command.hpp"

namespace scintray::cli {

void add_map_command(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "Height maps of surfaces");
  map->require_subcommand(1);
  add_map_describe_command(*map);
  add_map_prepare_command(*map);
  add_map_synthesize_command(*map);
}

}  // namespace scintray::cli
