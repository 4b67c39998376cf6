#include <CLI/CLI.hpp>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"

namespace scintray::cli {

void add_map_describe_command(CLI::App& map) {
  auto options = std::make_shared<MapOptions>();
  auto json = std::make_shared<bool>(false);
  CLI::App* app = map.add_subcommand("describe", "Print heights, slopes, lengths and directions of a map");
  add_map_options(*app, *options);
  add_json_flag(*app, *json);
  app->footer("Example: scintray map describe ground.gsf");
  app->callback([options, json] {
    const JsonAnswer answer(*json);
    const topography::HeightMap read = read_map(*options);
    print_description(read);
    print_warnings(read);
    answer.print([&] { return map_json(read); });
  });
}

}  // namespace scintray::cli
