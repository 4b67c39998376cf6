#include "scintray/cli/table_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/table_export_command.hpp"
#include "scintray/cli/table_import_command.hpp"
#include "scintray/cli/table_plot.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/prepare.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::cli {

namespace {

constexpr double kUmPerMm = 1000.0;

double length_um(const std::string& text) { return parse_quantity(text, Dimension::length) * kUmPerMm; }

struct BuildArguments {
  std::string map, output, level = "plane", tiling = "auto";
  std::string channel, pitch, width, unit, loess, incidence_step, azimuth_step;
  double inside_index = 0.0, outside_index = 1.0;
  bool periodic = false, no_refine = false;
  TableSettings settings;
};

ReadOptions read_options(const BuildArguments& arguments) {
  ReadOptions options;
  if (!arguments.pitch.empty()) options.pitch_um = length_um(arguments.pitch);
  if (!arguments.width.empty()) options.width_um = length_um(arguments.width);
  if (!arguments.unit.empty())
    options.height_unit_um = unit_factor(arguments.unit, Dimension::length) * kUmPerMm;
  if (!arguments.channel.empty()) options.channel = arguments.channel;
  options.periodic = arguments.periodic;
  return options;
}

void level(HeightMap& map, const std::string& how) {
  if (how == "none") return;
  if (how == "mean") return subtract_mean(map);
  if (how == "plane") return level_plane(map);
  constexpr std::string_view kPolynomial = "poly:";
  if (how.starts_with(kPolynomial) && how.size() == kPolynomial.size() + 1 && how.back() >= '0' &&
      how.back() <= '8')
    return level_polynomial(map, how.back() - '0');
  throw InputError({{}, "--level " + how + "; expected plane, mean, none or poly:N with N from 0 to 8", ""});
}

Tiling parse_tiling(const std::string& name) {
  if (name == "mirror") return Tiling::mirror;
  return name == "periodic" ? Tiling::periodic : Tiling::automatic;
}

void print_statistics(const HeightMap& map) {
  const MapStatistics s = map_statistics(map);
  std::cout << fmt::format("map          {} x {} points, pitch {:.6g} x {:.6g} um\n", map.columns, map.rows,
                           map.pitch_x_um, map.pitch_y_um);
  for (const std::string& step : map.steps) std::cout << "             " << step << "\n";
  std::cout << fmt::format("heights      Sa {:.4g} um, Sq {:.4g} um, Sz {:.4g} um ({:+.4g} to {:+.4g} um)\n",
                           s.sa_um, s.sq_um, s.sz_um, s.lowest_um, s.highest_um);
  std::cout << fmt::format("slopes       mean {:.2f} deg, rms {:.3f} along x, {:.3f} along y\n",
                           s.mean_slope_rad / kDegree, s.rms_slope_x, s.rms_slope_y);
}

void print_table(const SurfaceTable& table) {
  const TableProvenance& p = table.provenance();
  std::cout << fmt::format("map          {}\npreparation  {}\ntiling       {}\n", p.map, p.preparation,
                           p.tiling);
  std::cout << fmt::format("indices      {:g} inside, {:g} outside\n", table.index_pair().inside,
                           table.index_pair().outside);
  std::cout << fmt::format("rays         {} per azimuth, {} azimuths, seed {}; {} unclassified, {} cut\n",
                           p.rays_per_azimuth, p.azimuths, p.seed, p.unclassified, p.cut);
  std::cout << "built by     ScintRay " << p.version << "\n";
  for (const Side side : {Side::inside, Side::outside}) {
    std::cout << fmt::format("\nfrom {}\n{:>14}{:>14}{:>11}{:>18}\n",
                             side == Side::inside ? "inside" : "outside", "incidence deg", "reflectance",
                             "error", "mean slope deg");
    for (const TableNode& node : table.nodes(side))
      std::cout << fmt::format(
          "{:>14.4f}{:>14.5f}{:>11.5f}{:>18.3f}{}\n", node.incidence_rad / kDegree, node.reflectance,
          node.reflectance_error, node.mean_slope_rad / kDegree,
          node.traced_incidence_rad == node.incidence_rad
              ? ""
              : fmt::format("   traced at {:.4f} deg", node.traced_incidence_rad / kDegree));
  }
}

void build(BuildArguments arguments) {
  if (!arguments.incidence_step.empty())
    arguments.settings.incidence_step_rad = parse_quantity(arguments.incidence_step, Dimension::angle);
  if (!arguments.azimuth_step.empty())
    arguments.settings.azimuth_step_rad = parse_quantity(arguments.azimuth_step, Dimension::angle);
  arguments.settings.refine = !arguments.no_refine;

  HeightMap map = read_height_map(arguments.map, read_options(arguments));
  if (!arguments.loess.empty()) filter_loess_lines(map, length_um(arguments.loess));
  level(map, arguments.level);
  print_statistics(map);

  const Tiling tiling = parse_tiling(arguments.tiling);
  const HeightField field = make_height_field(map, tiling);
  TableProvenance provenance;
  provenance.map = arguments.map;
  provenance.preparation = map.history();
  provenance.tiling = tiling_name(map, tiling);

  const InterruptGuard guard;
  ProgressLine line(true);
  const auto progress = [&](double share) {
    line.show("table", 100.0 * share, 100.0, "percent");
    return !InterruptGuard::requested();
  };
  const SurfaceTable table = build_table(field, {arguments.inside_index, arguments.outside_index},
                                         arguments.settings, provenance, progress);
  line.clear();
  write_table(arguments.output, table);
  std::cout << fmt::format("table        {} and {} nodes; {} unclassified, {} cut\nwritten      {}\n",
                           table.nodes(Side::inside).size(), table.nodes(Side::outside).size(),
                           table.provenance().unclassified, table.provenance().cut, arguments.output);
}

void add_build(CLI::App& table) {
  auto arguments = std::make_shared<BuildArguments>();
  CLI::App* app = table.add_subcommand("build", "Trace a height map into a surface table");
  app->add_option(
         "map", arguments->map,
         "Height map: .gwy, .gsf, .ibw, Nanoscope (.spm, .001), .mi, .sdf, .x3p, text (matrix, x y z "
         "list, Gwyddion's export, profiler), also .gz; others through gwyddion where installed")
      ->required();
  app->add_option("--channel", arguments->channel,
                  "Channel of the file by name, as \"Height Sensor\"; without it, the height that a sensor "
                  "measured, else the height");
  app->add_option("-o,--output", arguments->output, "Table file to write (HDF5)")->required();
  app->add_option("--inside-index", arguments->inside_index, "Refractive index of the part whose face it is")
      ->required();
  app->add_option("--outside-index", arguments->outside_index, "Refractive index outside")->required();
  app->add_option("--level", arguments->level, "plane, mean, none, or poly:N")->capture_default_str();
  app->add_option("--loess", arguments->loess,
                  "Width of the LOESS along lines against tip oscillation, as \"2 um\"");
  app->add_option("--tiling", arguments->tiling, "How the map goes on beyond its edges")
      ->check(CLI::IsMember({"auto", "mirror", "periodic"}))
      ->capture_default_str();
  app->add_option("--pitch", arguments->pitch,
                  "Distance of points where the file does not say, as \"0.175 um\"");
  app->add_option("--width", arguments->width, "Width of the map where the file does not say, as \"90 um\"");
  app->add_option("--unit", arguments->unit, "Unit of the heights where the file does not say, as um");
  app->add_flag("--periodic", arguments->periodic, "The map is one period of a periodic surface");
  app->add_option("--rays", arguments->settings.rays, "Rays per incidence angle and azimuth")
      ->capture_default_str();
  app->add_option("--seed", arguments->settings.seed, "Seed of the random numbers")->capture_default_str();
  app->add_option("--incidence-step", arguments->incidence_step,
                  "Step of incidence, \"2.25 deg\" unless given");
  app->add_option("--azimuth-step", arguments->azimuth_step, "Step of azimuth, \"9 deg\" unless given");
  app->add_flag("--no-refine", arguments->no_refine, "No extra nodes where the reflectance changes fast");
  app->callback([arguments] { build(*arguments); });
}

void add_show(CLI::App& table) {
  auto file = std::make_shared<std::string>();
  auto plot = std::make_shared<std::string>();
  CLI::App* app = table.add_subcommand("show", "Print what is in a surface table");
  app->add_option("file", *file, "Table file (HDF5)")->required();
  app->add_option("--plot", *plot, "SVG file for reflectance and slopes against incidence");
  app->callback([file, plot] {
    const SurfaceTable read = read_table(*file);
    print_table(read);
    if (!plot->empty()) plot_table(*plot, read);
  });
}

struct SynthesisArguments {
  std::string kind, output, rms_height, correlation_length, fit_normal, fit_grazing;
  std::uint64_t seed = 1;
};

SynthesisRecipe recipe_of(const SynthesisArguments& arguments) {
  SynthesisRecipe recipe;
  if (arguments.kind == "ground") recipe = ground_recipe();
  if (arguments.kind == "polished") recipe = polished_recipe();
  if (!arguments.rms_height.empty()) recipe.gaussian.rms_height_um = length_um(arguments.rms_height);
  if (!arguments.correlation_length.empty())
    recipe.gaussian.correlation_length_um = length_um(arguments.correlation_length);
  if (arguments.kind == "gaussian" && (arguments.rms_height.empty() || arguments.correlation_length.empty()))
    throw InputError({{},
                      "a gaussian map without its size",
                      "give --rms-height and --correlation-length, for example \"0.9 um\" and \"4.8 um\""});
  recipe.seed = arguments.seed;
  return recipe;
}

void print_slopes_met(const HeightField& field) {
  std::cout << fmt::format("mean slope met, deg\n{:>11}{:>18}{:>18}\n", "incidence", "from inside",
                           "from outside");
  for (const double degrees : {0.0, 30.0, 45.0, 60.0, 75.0, 80.0, 85.0, 87.0, kGrazingStated_rad / kDegree}) {
    const Estimate inside = mean_slope_met(field, Side::inside, degrees * kDegree);
    const Estimate outside = mean_slope_met(field, Side::outside, degrees * kDegree);
    std::cout << fmt::format("{:>11.2f}{:>9.2f} +- {:.2f}{:>9.2f} +- {:.2f}\n", degrees,
                             inside.value / kDegree, inside.error / kDegree, outside.value / kDegree,
                             outside.error / kDegree);
  }
}

void synthesize_map(const SynthesisArguments& arguments) {
  SynthesisRecipe recipe = recipe_of(arguments);
  if (!arguments.fit_normal.empty()) {
    SlopeTarget target;
    target.normal_rad = parse_quantity(arguments.fit_normal, Dimension::angle);
    if (!arguments.fit_grazing.empty())
      target.grazing_rad = parse_quantity(arguments.fit_grazing, Dimension::angle);
    recipe = fit_recipe(recipe, target);
  }
  const HeightMap map = synthesize(recipe);
  print_statistics(map);
  print_slopes_met(make_height_field(map));
  write_gsf(arguments.output, map);
  std::cout << "written      " << arguments.output << " (one period: build tables with --periodic)\n";
}

void add_synthesize(CLI::App& table) {
  auto arguments = std::make_shared<SynthesisArguments>();
  CLI::App* app =
      table.add_subcommand("synthesize", "Make a height map from a recipe and say what slopes it shows");
  app->add_option("kind", arguments->kind, "ground, polished or gaussian")
      ->required()
      ->check(CLI::IsMember({"ground", "polished", "gaussian"}));
  app->add_option("-o,--output", arguments->output, "Height map to write (.gsf)")->required();
  app->add_option("--seed", arguments->seed, "Seed of the random numbers")->capture_default_str();
  app->add_option("--rms-height", arguments->rms_height, "Sq of the Gaussian relief, as \"0.9 um\"");
  app->add_option("--correlation-length", arguments->correlation_length,
                  "of the Gaussian relief, as \"4.8 um\"");
  CLI::Option* normal = app->add_option("--fit-normal", arguments->fit_normal,
                                        "Search the recipe for this mean slope at normal incidence");
  app->add_option("--fit-grazing", arguments->fit_grazing, "and, for ground, for this one at 88.5 deg")
      ->needs(normal);
  app->callback([arguments] { synthesize_map(*arguments); });
}

}  // namespace

void add_table_command(CLI::App& app) {
  CLI::App* table = app.add_subcommand("table", "Surface tables from height maps");
  table->require_subcommand(1);
  add_build(*table);
  add_show(*table);
  add_synthesize(*table);
  add_table_export_command(*table);
  add_table_import_command(*table);
}

}  // namespace scintray::cli
