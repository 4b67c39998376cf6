#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "scintray/cli/word_option.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/tables/bsdf_text.hpp"
#include "scintray/tables/davis.hpp"
#include "scintray/tables/lbnl.hpp"
#include "scintray/tables/table_csv.hpp"

namespace scintray::cli {

namespace {

/// Format of the written file.
enum class ExportFormat { davis, lbnl, bsdf, csv };
constexpr core::Word<ExportFormat> kExportFormats[] = {{"davis", ExportFormat::davis},
                                                       {"lbnl", ExportFormat::lbnl},
                                                       {"bsdf", ExportFormat::bsdf},
                                                       {"csv", ExportFormat::csv}};

struct ExportArguments {
  std::string table, output, wavelength;
  ExportFormat format = ExportFormat::csv;
  optics::Side side = optics::Side::inside;
  std::uint64_t rays = tables::BsdfSettings{}.rays, seed = 1;
};

std::size_t slice_of(const ExportArguments& arguments, const optics::SurfaceTable& table) {
  std::optional<double> wavelength;
  if (!arguments.wavelength.empty())
    wavelength = core::parse_quantity(arguments.wavelength, core::Dimension::wavelength);
  return tables::slice_at(table, wavelength);
}

void export_davis(const ExportArguments& arguments, const optics::SurfaceTable& table) {
  tables::DavisSettings settings;
  settings.side = arguments.side;
  settings.slice = slice_of(arguments, table);
  settings.seed = arguments.seed;
  const auto losses = tables::write_davis(arguments.output, table, settings);
  const tables::DavisFiles files = tables::davis_files(arguments.output);
  std::cout << "written      " << files.directions.string() << "\n             "
            << files.reflectances.string() << "\n";
  for (const std::string& loss : losses) std::cout << "note         " << loss << "\n";
}

void export_lbnl(const ExportArguments& arguments, const optics::SurfaceTable& table) {
  tables::LbnlSettings settings;
  settings.side = arguments.side;
  settings.slice = slice_of(arguments, table);
  settings.seed = arguments.seed;
  const auto losses = tables::write_lbnl(arguments.output, table, settings);
  std::cout << "written      " << arguments.output << "\n";
  for (const std::string& loss : losses) std::cout << "note         " << loss << "\n";
}

void export_bsdf(const ExportArguments& arguments, const optics::SurfaceTable& table) {
  const std::filesystem::path name = arguments.output;
  if (name.extension() != ".bsdf")
    throw core::InputError({{arguments.output},
                            "a name that does not end in .bsdf",
                            "NAME.bsdf makes NAME_brdf.bsdf and NAME_btdf.bsdf"});
  for (const tables::Leaving way : {tables::Leaving::reflected, tables::Leaving::transmitted}) {
    tables::BsdfSettings settings;
    settings.side = arguments.side;
    settings.slice = slice_of(arguments, table);
    settings.way = way;
    settings.rays = arguments.rays;
    settings.seed = arguments.seed;
    auto path = name;
    path.replace_filename(name.stem().string() + (way == tables::Leaving::reflected ? "_brdf" : "_btdf") +
                          ".bsdf");
    tables::write_bsdf(path, tables::bsdf_of(table, settings), table, settings);
    std::cout << "written      " << path.string() << "\n";
  }
}

void export_table(const ExportArguments& arguments) {
  const optics::SurfaceTable table = optics::read_table(arguments.table);
  switch (arguments.format) {
    case ExportFormat::davis:
      return export_davis(arguments, table);
    case ExportFormat::lbnl:
      return export_lbnl(arguments, table);
    case ExportFormat::bsdf:
      return export_bsdf(arguments, table);
    case ExportFormat::csv:
      break;
  }
  tables::write_table_csv(arguments.output, table);
  std::cout << "written      " << arguments.output << "\n";
}

}  // namespace

void add_table_export_command(CLI::App& table) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* app = table.add_subcommand("export", "Write a surface table for other programs");
  app->add_option("table", arguments->table, "Table file (HDF5)")->required();
  add_word_option(*app, "--format", arguments->format, kExportFormats,
                  "davis: Geant4's LUTDAVIS pair; lbnl: its table of reflected light (model LUT); bsdf: "
                  "tabulated BRDF and BTDF of Zemax and LightTools; csv: "
                  "densities of both sides")
      ->required();
  app->add_option("-o,--output", arguments->output,
                  "Name to write: X_LUT.z or X_LUT.dat (with X_LUTR beside it), X.z or X.dat (lbnl), "
                  "NAME.bsdf (NAME_brdf.bsdf and "
                  "NAME_btdf.bsdf), or a CSV file")
      ->required();
  add_word_option(*app, "--side", arguments->side, kSideWords,
                  "Side of the incident light (davis, lbnl, bsdf)")
      ->default_str(core::word_of(kSideWords, arguments->side));
  app->add_option("--wavelength", arguments->wavelength,
                  "Wavelength, for a table of several, as \"420 nm\" (davis, lbnl, bsdf)");
  app->add_option("--rays", arguments->rays, "Points of the distribution per angle (bsdf)")
      ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{100'000'000}))
      ->capture_default_str();
  app->add_option("--seed", arguments->seed, "Seed of the points (davis, lbnl, bsdf)")->capture_default_str();
  app->footer("Example: scintray table export ground.h5 --format davis -o Ground_LUT.z");
  app->callback([arguments] { export_table(*arguments); });
}

}  // namespace scintray::cli
