#include <CLI/CLI.hpp>
#include <memory>

#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"
#include "scintray/cli/table_options.hpp"
#include "scintray/cli/word_option.hpp"

namespace scintray::cli {

namespace {

constexpr core::Word<topography::Tiling> kTilings[] = {{"auto", topography::Tiling::automatic},
                                                       {"mirror", topography::Tiling::mirror},
                                                       {"periodic", topography::Tiling::periodic}};

struct BuildArguments {
  MapOptions map;
  PreparationOptions preparation;
  TracingOptions tracing;
  std::string output;
  topography::Tiling tiling = topography::Tiling::automatic;
};

void build(const BuildArguments& arguments) {
  const std::vector<topography::SpectralPoint> spectrum =
      between(arguments.tracing, database_of(arguments.tracing)).spectrum();
  topography::HeightMap map = read_map(arguments.map);
  topography::prepare(map, preparation_of(arguments.preparation));
  print_summary(map);
  print_warnings(map);

  const optics::HeightField field = topography::make_height_field(map, arguments.tiling);
  optics::TableProvenance provenance;
  provenance.map = arguments.map.map;
  provenance.preparation = map.history();
  provenance.tiling = topography::tiling_name(map, arguments.tiling);
  write_and_report(arguments.output, build_with_progress([&](const topography::TableProgress& progress) {
                     return topography::build_table(field, spectrum, settings_of(arguments.tracing),
                                                    provenance, progress);
                   }));
}

}  // namespace

void add_table_build_command(CLI::App& table) {
  auto arguments = std::make_shared<BuildArguments>();
  CLI::App* app = table.add_subcommand("build", "Trace a height map into a surface table");
  add_map_options(*app, arguments->map);
  app->add_option("-o,--output", arguments->output, "Table file to write (HDF5)")->required();
  add_tracing_options(*app, arguments->tracing);
  add_preparation_options(*app, arguments->preparation);
  add_word_option(*app, "--tiling", arguments->tiling, kTilings, "Continuation of the map beyond its edges")
      ->default_str(core::word_of(kTilings, arguments->tiling));
  app->callback([arguments] { build(*arguments); });
}

}  // namespace scintray::cli
