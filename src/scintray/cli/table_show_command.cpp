#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/cli/table_options.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::cli {

namespace {

constexpr double kWidth = 640, kHeight = 420, kLeft = 60, kTop = 30, kPlotWidth = 520, kPlotHeight = 330;

double x_of(double degrees) { return kLeft + kPlotWidth * degrees / 90.0; }
double y_of(double share) { return kTop + kPlotHeight * (1.0 - share); }

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const std::string& colour = "black") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y,
                     anchor, colour, words);
}

std::string axes() {
  std::string svg =
      fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"black\"/>\n",
                  kLeft, kTop, kPlotWidth, kPlotHeight);
  for (int tick = 0; tick <= 90; tick += 15)
    svg += text(x_of(tick), y_of(0) + 18, "middle", fmt::format("{}", tick));
  for (int tick = 0; tick <= 10; tick += 2)
    svg += text(kLeft - 8, y_of(tick / 10.0) + 4, "end", fmt::format("{:.1f}", tick / 10.0));
  for (int tick = 0; tick <= 90; tick += 15)
    svg += text(kLeft + kPlotWidth + 8, y_of(tick / 90.0) + 4, "start", fmt::format("{}", tick));
  svg += text(kLeft + 0.5 * kPlotWidth, kHeight - 18, "middle", "incidence (deg)");
  svg += text(kLeft, kTop - 10, "start", "reflectance (lines)");
  svg += text(kLeft + kPlotWidth, kTop - 10, "end", "mean visible slope, deg (dashed)");
  return svg;
}

std::string curves(const optics::SurfaceTable& table, optics::Side side, const std::string& colour) {
  std::string reflectance, slope;
  for (const optics::TableNode& node : table.nodes(side)) {
    const double x = x_of(node.incidence_rad / core::kDegree);
    reflectance += fmt::format("{:.2f},{:.2f} ", x, y_of(node.reflectance));
    slope += fmt::format("{:.2f},{:.2f} ", x, y_of(node.mean_slope_rad / (0.5 * core::kPi)));
  }
  return fmt::format(
      "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n"
      "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-dasharray=\"5 4\"/>\n",
      reflectance, colour, slope, colour);
}

/// Writes an SVG of reflectance (left axis, 0 to 1) and mean visible slope (right axis, 0 to 90 deg)
/// against incidence from both sides. SystemError when it cannot be written.
void plot_table(const std::filesystem::path& path, const optics::SurfaceTable& table) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth, kHeight);
  svg += axes();
  const optics::IndexPair& index = table.index_pair();
  const std::string inside = "#b03020", outside = "#2050a0";
  svg += curves(table, optics::Side::inside, inside) + curves(table, optics::Side::outside, outside);
  svg += text(kLeft + 12, kTop + 20, "start",
              fmt::format("from inside, {:g} to {:g}", index.inside, index.outside), inside);
  svg += text(kLeft + 12, kTop + 38, "start",
              fmt::format("from outside, {:g} to {:g}", index.outside, index.inside), outside);
  svg += "</svg>\n";
  core::write_whole_file(path, svg, "the plot");
}

void print_provenance(const optics::SurfaceTable& table) {
  const optics::TableProvenance& p = table.provenance();
  std::cout << fmt::format("map          {}\n", p.map);
  if (!p.stack.empty()) std::cout << fmt::format("stack        {}\n", p.stack);
  std::cout << fmt::format("preparation  {}\ntiling       {}\n", p.preparation, p.tiling);
  std::cout << fmt::format("rays         {} per azimuth, {} azimuths, seed {}; {} unclassified, {} cut\n",
                           p.rays_per_azimuth, p.azimuths, p.seed, p.unclassified, p.cut);
  if (p.target_error > 0.0)
    std::cout << fmt::format("error        rays added down to {:g}; not reached at {} nodes\n",
                             p.target_error, p.unconverged);
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
  auto json = std::make_shared<bool>(false);
  CLI::App* app = table.add_subcommand("show", "Print the content of a surface table");
  app->add_option("file", *file, "Table file (HDF5)")->required();
  app->add_option("--plot", *plot, "SVG file for reflectance and slopes against incidence");
  add_json_flag(*app, *json);
  app->footer("Example: scintray table show ground.h5 --plot ground.svg");
  app->callback([file, plot, json] {
    const JsonAnswer answer(*json);
    const optics::SurfaceTable read = optics::read_table(*file);
    print_provenance(read);
    for (std::size_t slice = 0; slice < read.slices().size(); ++slice) print_slice(read, slice);
    answer.print([&] { return table_json(read); });
    if (!plot->empty()) plot_table(*plot, read);
  });
}

}  // namespace scintray::cli
