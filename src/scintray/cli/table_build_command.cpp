#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"
#include "scintray/cli/resume_options.hpp"
#include "scintray/cli/table_options.hpp"
#include "scintray/cli/word_option.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/topography/resumable_table.hpp"

namespace scintray::cli {

namespace {

constexpr core::Word<topography::Tiling> kTilings[] = {{"auto", topography::Tiling::automatic},
                                                       {"mirror", topography::Tiling::mirror},
                                                       {"periodic", topography::Tiling::periodic}};

struct BuildArguments {
  bool json = false;
  MapOptions map;
  PreparationOptions preparation;
  TracingOptions tracing;
  std::string output;
  ResumeOptions resume;
  topography::Tiling tiling = topography::Tiling::automatic;
};

void build(const BuildArguments& arguments) {
  const JsonAnswer answer(arguments.json);
  const std::optional<core::FileLock> claim = core::claim_output(arguments.output);
  const Between media = between(arguments.tracing, database_of(arguments.tracing));
  const std::vector<topography::SpectralPoint> spectrum = media.spectrum();
  topography::HeightMap map = read_map(arguments.map);
  const topography::Preparation preparation = preparation_of(arguments.preparation);
  topography::prepare(map, preparation);
  print_summary(map);
  print_warnings(map);

  const topography::TableSettings settings = settings_of(arguments.tracing);
  const std::string source = materials::height_map_key(
      {arguments.map.map, read_options(arguments.map), preparation, arguments.tiling});
  const materials::CacheEntry entry{
      materials::table_key("file " + arguments.map.map + ": " + source, settings, spectrum),
      arguments.map.map, media.names()};
  core::Journal journal(journal_settings(arguments.resume, arguments.output), "table\n" + entry.key);
  const auto trace = [&](const topography::TableProgress& progress) {
    optics::TableProvenance provenance;
    provenance.map = arguments.map.map;
    provenance.preparation = map.history();
    provenance.tiling = topography::tiling_name(map, arguments.tiling);
    return topography::build_table(topography::make_height_field(map, arguments.tiling), spectrum, settings,
                                   provenance, progress, journal);
  };
  const std::shared_ptr<const optics::SurfaceTable> built = [&] {
    try {
      return table_with_progress(entry, trace);
    } catch (const topography::TableStopped&) {
      if (journal.pieces() > 0) std::cerr << "what was finished is kept; --resume goes on after it\n";
      throw;
    }
  }();
  write_and_report(arguments.output, *built);
  journal.remove();
  answer.print([&] { return table_json(*built); });
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
  add_resume_flags(*app, arguments->resume);
  add_json_flag(*app, arguments->json);
  app->footer(
      "Example: scintray table build ground.gsf --inside LSO --outside air --wavelength \"420 nm\" -o "
      "ground.h5");
  app->callback([arguments] { build(*arguments); });
}

}  // namespace scintray::cli
