#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "scintray/cli/word_option.hpp"
#include "scintray/core/error.hpp"
#include "scintray/tables/davis.hpp"
#include "scintray/tables/lbnl.hpp"

namespace scintray::cli {

namespace {

/// Format of the file.
enum class ImportFormat { davis, lbnl };
constexpr core::Word<ImportFormat> kImportFormats[] = {{"davis", ImportFormat::davis},
                                                       {"lbnl", ImportFormat::lbnl}};

struct ImportArguments {
  std::string file, output;
  ImportFormat format = ImportFormat::davis;
  std::optional<tables::Unreflected> unreflected;
  std::optional<double> reflectance;
  tables::ImportSettings settings;
};

void require_options_of_format(const ImportArguments& arguments) {
  const bool davis = arguments.format == ImportFormat::davis;
  if (davis && arguments.reflectance)
    throw core::InputError(
        {{}, "--reflectance with --format davis", "the pair contains its own reflectances"});
  if (!davis && arguments.unreflected)
    throw core::InputError(
        {{}, "--unreflected with --format lbnl", "light that it does not reflect is absorbed"});
  if (davis && !arguments.unreflected)
    throw core::InputError(
        {{},
         "a Davis pair without --unreflected",
         "the pair does not state whether light that is not reflected is transmitted (transmitted: Geant4 "
         "with EFFICIENCY 0) or absorbed at the surface (absorbed: with EFFICIENCY above 0)"});
  if (!davis && !arguments.reflectance)
    throw core::InputError({{},
                            "an LBNL table without --reflectance",
                            "the file contains none: use the REFLECTIVITY that the surface has in Geant4"});
}

void import_table(ImportArguments arguments) {
  require_options_of_format(arguments);
  tables::ImportSettings& settings = arguments.settings;
  settings.unreflected = arguments.unreflected.value_or(tables::Unreflected::transmitted);
  settings.reflectance = arguments.reflectance.value_or(1.0);
  const optics::SurfaceTable table = arguments.format == ImportFormat::davis
                                         ? tables::read_davis(arguments.file, settings)
                                         : tables::read_lbnl(arguments.file, settings);
  optics::write_table(arguments.output, table);
  std::cout << "read         " << table.provenance().map << "\n             "
            << table.provenance().preparation << "\nwritten      " << arguments.output << "\n";
}

}  // namespace

void add_table_import_command(CLI::App& table) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* app = table.add_subcommand("import", "Convert another program's surface table");
  app->add_option("file", arguments->file,
                  "davis: X_LUT.z or X_LUT.dat, with X_LUTR beside it; lbnl: one of the 21 finishes' files")
      ->required();
  add_word_option(*app, "--format", arguments->format, kImportFormats,
                  "Geant4's LUTDAVIS pair or LBNL's table (model LUT)")
      ->required();
  app->add_option("-o,--output", arguments->output, "Table file to write (HDF5)")->required();
  app->add_option("--inside-index", arguments->settings.index.inside,
                  "Refractive index of the crystal of the table, which the files do not state")
      ->required();
  app->add_option("--outside-index", arguments->settings.index.outside, "Refractive index outside")
      ->required();
  add_word_option(*app, "--from-outside", arguments->settings.from_outside, tables::kFromOutsideWords,
                  "Treatment of light incident from outside, which the files do not describe: "
                  "smooth (Fresnel), mirror or absorb")
      ->required();
  add_word_option(*app, "--unreflected", arguments->unreflected, tables::kUnreflectedWords,
                  "davis: treatment of light that is not reflected");
  app->add_option("--reflectance", arguments->reflectance, "lbnl: Geant4's REFLECTIVITY of the surface");
  app->footer(
      "Example: scintray table import Rough_LUT.z --format davis --inside-index 1.82 --outside-index 1 "
      "--from-outside smooth --unreflected transmitted -o rough.h5");
  app->callback([arguments] { import_table(*arguments); });
}

}  // namespace scintray::cli
