#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "scintray/cli/word_option.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/tables/bsdf_text.hpp"
#include "scintray/tables/davis.hpp"
#include "scintray/tables/lbnl.hpp"

namespace scintray::cli {

namespace {

/// Format of the file.
enum class ImportFormat { davis, lbnl, bsdf };
constexpr core::Word<ImportFormat> kImportFormats[] = {
    {"davis", ImportFormat::davis}, {"lbnl", ImportFormat::lbnl}, {"bsdf", ImportFormat::bsdf}};

struct ImportArguments {
  std::string file, output;
  ImportFormat format = ImportFormat::davis;
  std::optional<tables::Unreflected> unreflected;
  std::optional<double> reflectance;
  std::string transmitted;  ///< file of the BTDF; empty: none
  tables::ImportSettings settings;
};

void require_options_of_format(const ImportArguments& arguments) {
  const bool davis = arguments.format == ImportFormat::davis;
  const bool bsdf = arguments.format == ImportFormat::bsdf;
  if (!bsdf && !arguments.transmitted.empty())
    throw core::InputError(
        {{}, "--transmitted without --format bsdf", "it names the BTDF that belongs to a BRDF"});
  if (bsdf && (arguments.reflectance || arguments.unreflected))
    throw core::InputError({{},
                            "--reflectance or --unreflected with --format bsdf",
                            "the files contain the shares; --transmitted names that of transmitted light"});
  if (davis && arguments.reflectance)
    throw core::InputError(
        {{}, "--reflectance with --format davis", "the pair contains its own reflectances"});
  if (!davis && !bsdf && arguments.unreflected)
    throw core::InputError(
        {{}, "--unreflected with --format lbnl", "light that it does not reflect is absorbed"});
  if (davis && !arguments.unreflected)
    throw core::InputError(
        {{},
         "a Davis pair without --unreflected",
         "the pair does not state whether light that is not reflected is transmitted (transmitted: Geant4 "
         "with EFFICIENCY 0) or absorbed at the surface (absorbed: with EFFICIENCY above 0)"});
  if (!davis && !bsdf && !arguments.reflectance)
    throw core::InputError({{},
                            "an LBNL table without --reflectance",
                            "the file contains none: use the REFLECTIVITY that the surface has in Geant4"});
}

optics::SurfaceTable read_as(const ImportArguments& arguments, const tables::ImportSettings& settings) {
  if (arguments.format == ImportFormat::davis) return tables::read_davis(arguments.file, settings);
  if (arguments.format == ImportFormat::lbnl) return tables::read_lbnl(arguments.file, settings);
  const tables::Bsdf reflected = tables::parse_bsdf(config::read_text_file(arguments.file), arguments.file);
  const std::string name = std::filesystem::path(arguments.file).filename().string();
  if (arguments.transmitted.empty()) return tables::bsdf_table(reflected, nullptr, settings, name);
  const tables::Bsdf transmitted = tables::parse_bsdf(config::read_text_file(arguments.transmitted),
                                                      arguments.transmitted, tables::Leaving::transmitted);
  return tables::bsdf_table(
      reflected, &transmitted, settings,
      name + " and " + std::filesystem::path(arguments.transmitted).filename().string());
}

void import_table(ImportArguments arguments) {
  require_options_of_format(arguments);
  tables::ImportSettings& settings = arguments.settings;
  settings.unreflected = arguments.unreflected.value_or(tables::Unreflected::transmitted);
  settings.reflectance = arguments.reflectance.value_or(1.0);
  const optics::SurfaceTable table = read_as(arguments, settings);
  optics::write_table(arguments.output, table);
  std::cout << "read         " << table.provenance().map << "\n             "
            << table.provenance().preparation << "\nwritten      " << arguments.output << "\n";
}

}  // namespace

void add_table_import_command(CLI::App& table) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* app = table.add_subcommand("import", "Convert another program's surface table");
  app->add_option("file", arguments->file,
                  "davis: X_LUT.z or X_LUT.dat, with X_LUTR beside it; lbnl: one of the 21 finishes' files; "
                  "bsdf: a BRDF of "
                  "Zemax")
      ->required();
  add_word_option(*app, "--format", arguments->format, kImportFormats,
                  "Geant4's LUTDAVIS pair, LBNL's table (model LUT), or tabulated BSDF of Zemax")
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
  app->add_option("--transmitted", arguments->transmitted,
                  "bsdf: the BTDF beside the BRDF; without it nothing is transmitted");
  app->footer(
      "Example: scintray table import Rough_LUT.z --format davis --inside-index 1.82 --outside-index 1 "
      "--from-outside smooth --unreflected transmitted -o rough.h5");
  app->callback([arguments] { import_table(*arguments); });
}

}  // namespace scintray::cli
