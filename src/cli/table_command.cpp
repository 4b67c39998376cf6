#include "scintray/cli/table_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/table_plot.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::cli {

namespace {

struct BuildArguments {
  MapOptions map;
  PreparationOptions preparation;
  std::string output, tiling = "auto", incidence_step, azimuth_step;
  double inside_index = 0.0, outside_index = 1.0;
  bool no_refine = false;
  TableSettings settings;
};

Tiling parse_tiling(const std::string& name) {
  if (name == "mirror") return Tiling::mirror;
  return name == "periodic" ? Tiling::periodic : Tiling::automatic;
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

  HeightMap map = read_map(arguments.map);
  prepare(map, preparation_of(arguments.preparation));
  print_summary(map);
  print_warnings(map);

  const Tiling tiling = parse_tiling(arguments.tiling);
  const HeightField field = make_height_field(map, tiling);
  TableProvenance provenance;
  provenance.map = arguments.map.map;
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
  add_map_options(*app, arguments->map);
  app->add_option("-o,--output", arguments->output, "Table file to write (HDF5)")->required();
  app->add_option("--inside-index", arguments->inside_index, "Refractive index of the part whose face it is")
      ->required();
  app->add_option("--outside-index", arguments->outside_index, "Refractive index outside")->required();
  add_preparation_options(*app, arguments->preparation);
  app->add_option("--tiling", arguments->tiling, "How the map goes on beyond its edges")
      ->check(CLI::IsMember({"auto", "mirror", "periodic"}))
      ->capture_default_str();
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

}  // namespace

void add_table_command(CLI::App& app) {
  CLI::App* table = app.add_subcommand("table", "Surface tables, and the surfaces of the library");
  table->require_subcommand(1);
  add_build(*table);
  add_show(*table);
  add_table_list_command(*table);
  add_table_compare_command(*table);
}

}  // namespace scintray::cli
