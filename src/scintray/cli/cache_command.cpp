#include <CLI/CLI.hpp>

#include "scintray/cli/commands.hpp"

namespace scintray::cli {

void add_cache_command(CLI::App& app) {
  CLI::App* cache = app.add_subcommand("cache", "Surface tables kept between runs");
  cache->require_subcommand(1);
  cache->footer("Example: scintray cache list");
  for (const AddCommand add : cache_commands()) add(*cache);
}

}  // namespace scintray::cli
