#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/table_plot.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::cli {

namespace {

void print_provenance(const optics::SurfaceTable& table) {
  const optics::TableProvenance& p = table.provenance();
  std::cout << fmt::format("map          {}\n", p.map);
  if (!p.stack.empty()) std::cout << fmt::format("stack        {}\n", p.stack);
  std::cout << fmt::format("preparation  {}\ntiling       {}\n", p.preparation, p.tiling);
  std::cout << fmt::format("rays         {} per azimuth, {} azimuths, seed {}; {} unclassified, {} cut\n",
                           p.rays_per_azimuth, p.azimuths, p.seed, p.unclassified, p.cut);
  if (p.target_error > 0.0)
    std::cout << fmt::format("error        rays added down to {:g}; {} nodes missed it\n", p.target_error,
                             p.unconverged);
  if (!p.reciprocity.empty()) std::cout << fmt::format("reciprocal   {}\n", p.reciprocity);
  std::cout << "built by     ScintRay " << p.version << "\n";
}

void print_slice(const optics::SurfaceTable& table, std::size_t number) {
  const optics::TableSlice& slice = table.slices()[number];
  std::cout << fmt::format("\nindices      {:g} inside, {:g} outside", slice.index.inside,
                           slice.index.outside);
  if (slice.wavelength_nm > 0.0) std::cout << fmt::format(" at {:g} nm", slice.wavelength_nm);
  if (table.azimuth_kind() == optics::AzimuthKind::directional)
    std::cout << fmt::format(", incidence from azimuth {:.2f} deg", slice.azimuth_rad / core::kDegree);
  std::cout << "\n";
  for (const optics::Side side : {optics::Side::inside, optics::Side::outside}) {
    std::cout << fmt::format("\nfrom {}\n{:>14}{:>14}{:>11}{:>14}{:>18}\n",
                             side == optics::Side::inside ? "inside" : "outside", "incidence deg",
                             "reflectance", "error", "absorptance", "mean slope deg");
    for (const optics::TableNode& node : slice.nodes(side))
      std::cout << fmt::format(
          "{:>14.4f}{:>14.5f}{:>11.5f}{:>14.5f}{:>18.3f}{}\n", node.incidence_rad / core::kDegree,
          node.reflectance, node.reflectance_error, node.absorptance, node.mean_slope_rad / core::kDegree,
          node.traced_incidence_rad == node.incidence_rad
              ? ""
              : fmt::format("   traced at {:.4f} deg", node.traced_incidence_rad / core::kDegree));
  }
}

}  // namespace

void add_table_show_command(CLI::App& table) {
  auto file = std::make_shared<std::string>();
  auto plot = std::make_shared<std::string>();
  CLI::App* app = table.add_subcommand("show", "Print what is in a surface table");
  app->add_option("file", *file, "Table file (HDF5)")->required();
  app->add_option("--plot", *plot, "SVG file for reflectance and slopes against incidence");
  app->callback([file, plot] {
    const optics::SurfaceTable read = optics::read_table(*file);
    print_provenance(read);
    for (std::size_t slice = 0; slice < read.slices().size(); ++slice) print_slice(read, slice);
    if (!plot->empty()) plot_table(*plot, read);
  });
}

}  // namespace scintray::cli
