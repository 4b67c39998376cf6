#include <CLI/CLI.hpp>
#include <memory>

#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"

namespace scintray::cli {

void add_map_describe_command(CLI::App& map) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* app = map.add_subcommand("describe", "Print heights, slopes, lengths and directions of a map");
  add_map_options(*app, *options);
  app->callback([options] {
    const topography::HeightMap read = read_map(*options);
    print_description(read);
    print_warnings(read);
  });
}

}  // namespace scintray::cli
