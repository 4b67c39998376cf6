#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/bsdf_text.hpp"
#include "scintray/exchange/davis.hpp"
#include "scintray/exchange/table_csv.hpp"

namespace scintray::cli {

namespace {

struct ExportArguments {
  std::string table, format, output, wavelength, side = "inside";
  std::uint64_t rays = exchange::BsdfSettings{}.rays, seed = 1;
};

std::size_t slice_of(const ExportArguments& arguments, const optics::SurfaceTable& table) {
  std::optional<double> wavelength;
  if (!arguments.wavelength.empty())
    wavelength = core::parse_quantity(arguments.wavelength, core::Dimension::wavelength);
  return exchange::slice_at(table, wavelength);
}

void export_davis(const ExportArguments& arguments, const optics::SurfaceTable& table, optics::Side side) {
  exchange::DavisSettings settings;
  settings.side = side;
  settings.slice = slice_of(arguments, table);
  settings.seed = arguments.seed;
  const auto losses = exchange::write_davis(arguments.output, table, settings);
  const exchange::DavisFiles files = exchange::davis_files(arguments.output);
  std::cout << "written      " << files.directions.string() << "\n             "
            << files.reflectances.string() << "\n";
  for (const std::string& loss : losses) std::cout << "note         " << loss << "\n";
}

void export_bsdf(const ExportArguments& arguments, const optics::SurfaceTable& table, optics::Side side) {
  const std::filesystem::path name = arguments.output;
  if (name.extension() != ".bsdf")
    throw core::InputError({{arguments.output},
                            "a name that does not end in .bsdf",
                            "NAME.bsdf makes NAME_brdf.bsdf and NAME_btdf.bsdf"});
  for (const exchange::Leaving way : {exchange::Leaving::reflected, exchange::Leaving::transmitted}) {
    exchange::BsdfSettings settings;
    settings.side = side;
    settings.slice = slice_of(arguments, table);
    settings.way = way;
    settings.rays = arguments.rays;
    settings.seed = arguments.seed;
    auto path = name;
    path.replace_filename(name.stem().string() + (way == exchange::Leaving::reflected ? "_brdf" : "_btdf") +
                          ".bsdf");
    exchange::write_bsdf(path, exchange::bsdf_of(table, settings), table, settings);
    std::cout << "written      " << path.string() << "\n";
  }
}

void export_table(const ExportArguments& arguments) {
  const optics::SurfaceTable table = optics::read_table(arguments.table);
  const optics::Side side = arguments.side == "inside" ? optics::Side::inside : optics::Side::outside;
  if (arguments.format == "davis") return export_davis(arguments, table, side);
  if (arguments.format == "bsdf") return export_bsdf(arguments, table, side);
  exchange::write_table_csv(arguments.output, table);
  std::cout << "written      " << arguments.output << "\n";
}

}  // namespace

void add_table_export_command(CLI::App& table) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* app = table.add_subcommand("export", "Write a surface table for other programs");
  app->add_option("table", arguments->table, "Table file (HDF5)")->required();
  app->add_option(
         "--format", arguments->format,
         "davis: Geant4's LUTDAVIS pair; bsdf: tabulated BRDF and BTDF of Zemax and LightTools; csv: "
         "densities of both sides")
      ->required()
      ->check(CLI::IsMember({"davis", "bsdf", "csv"}));
  app->add_option(
         "-o,--output", arguments->output,
         "Name to write: X_LUT.z or X_LUT.dat (with X_LUTR beside it), NAME.bsdf (NAME_brdf.bsdf and "
         "NAME_btdf.bsdf), or a CSV file")
      ->required();
  app->add_option("--side", arguments->side, "Where the light comes from (davis, bsdf)")
      ->check(CLI::IsMember({"inside", "outside"}))
      ->capture_default_str();
  app->add_option("--wavelength", arguments->wavelength,
                  "Which wavelength of a table of several, as \"420 nm\" (davis, bsdf)");
  app->add_option("--rays", arguments->rays, "Points of the distribution per angle (bsdf)")
      ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{100'000'000}))
      ->capture_default_str();
  app->add_option("--seed", arguments->seed, "Seed of the points (davis, bsdf)")->capture_default_str();
  app->callback([arguments] { export_table(*arguments); });
}

}  // namespace scintray::cli
