#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "scintray/cli/goniometer_options.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/goniometer_plots.hpp"

namespace scintray::cli {

namespace {

constexpr std::uint64_t kComparedRays = 200'000;
/// Rays for the directions, whose bins contain a few in ten thousand of the rays.
constexpr std::uint64_t kDirectionFactor = 10;

struct CompareOptions {
  SampleOptions sample;
  std::vector<std::string> surfaces, outside{"air"};
  std::string angle = "45 deg", slopes, reflectance, directions;
  bool on_the_spot = false;
};

/// Steps of 2.5 deg, and 88.5 deg, the incidence of the grazing slopes of recipes.
std::vector<double> incidences() {
  std::vector<double> angles;
  for (double angle = 0.0; angle < 88.0; angle += 2.5) angles.push_back(angle * core::kDegree);
  angles.push_back(88.5 * core::kDegree);
  return angles;
}

/// The surfaces between the inside medium and one outside medium.
std::vector<analysis::SampleSurface> make_all(const CompareOptions& options, const std::string& outside,
                                              bool on_the_spot) {
  ProgressLine line(true);
  materials::SurfaceFactory factory = watched_factory(line);
  const materials::MaterialDatabase database = database_of(options.sample);
  std::vector<analysis::SampleSurface> all;
  for (const std::string& name : options.surfaces)
    all.push_back(analysis::make_sample_surface(database, factory, place_of(options.sample, name, outside),
                                                on_the_spot));
  return all;
}

/// Rows of numbers, a column for each surface.
class Columns {
 public:
  Columns(const std::string& what, const std::vector<std::string>& names) {
    std::cout << "\n" << what << "\n" << fmt::format("{:>8}", "deg");
    for (const std::string& name : names) {
      widths_.push_back(std::max<std::size_t>(21, name.size()) + 2);
      std::cout << fmt::format("{:>{}}", name, widths_.back());
    }
    std::cout << "\n";
  }
  void row(double degrees, const std::vector<std::string>& cells) const {
    std::cout << fmt::format("{:>8.2f}", degrees);
    for (std::size_t k = 0; k < cells.size(); ++k) std::cout << fmt::format("{:>{}}", cells[k], widths_[k]);
    std::cout << "\n";
  }

 private:
  std::vector<std::size_t> widths_;
};

analysis::GoniometerSettings settings_of(const CompareOptions& options) {
  analysis::GoniometerSettings settings;
  settings.rays = options.sample.rays;
  settings.seed = options.sample.seed;
  settings.wavelength_nm = place_of(options.sample, "", "").wavelength_nm;
  return settings;
}

void write(const std::string& path, const report::Plot& plot) {
  report::write_page(path, report::svg_file(plot));
  std::cout << "written      " << path << "\n";
}

void slopes(const CompareOptions& options) {
  const std::vector<analysis::SampleSurface> all = make_all(options, options.outside.front(), true);
  const Columns columns("mean visible slope from inside (deg) against incidence", options.surfaces);
  report::Plot plot =
      report::incidence_plot("Mean visible slope against incidence", "mean visible slope (deg)");
  plot.series.resize(all.size());
  for (const double angle : incidences()) {
    std::vector<std::string> cells;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const core::Estimate slope = analysis::mean_visible_slope(all[k].surface, optics::Side::inside, angle);
      cells.push_back(
          fmt::format("{:.3f} +- {:.3f}", slope.value / core::kDegree, slope.error / core::kDegree));
      report::PlotSeries& series = plot.series[k];
      series.label = options.surfaces[k];
      series.x.push_back(angle / core::kDegree);
      series.y.push_back(slope.value / core::kDegree);
    }
    columns.row(angle / core::kDegree, cells);
  }
  write(options.slopes, plot);
}

/// Prints reflectances into one medium, and adds them to the plot.
void reflectance_into(const CompareOptions& options, const std::string& outside, report::Plot& plot) {
  const std::vector<analysis::SampleSurface> all = make_all(options, outside, options.on_the_spot);
  const optics::IndexPair index = all.front().index;
  const std::vector<double> angles = incidences();
  const std::string suffix = fmt::format(", n {:.2f}", index.outside);
  std::vector<std::vector<analysis::GoniometerReading>> readings;
  for (const analysis::SampleSurface& sample : all) {
    readings.push_back(analysis::sweep_incidence(sample.surface, index, settings_of(options), angles));
    plot.series.push_back(report::reflectance_series(sample.place.surface + suffix, readings.back()));
  }
  plot.series.push_back(report::fresnel_series("Fresnel" + suffix, index.inside, index.outside));

  std::vector<std::string> names = options.surfaces;
  names.push_back("Fresnel");
  std::string what = fmt::format("reflectance from inside into {} (n {:.4f})", outside, index.outside);
  if (index.inside > index.outside)
    what +=
        fmt::format(", critical angle {:.2f} deg", std::asin(index.outside / index.inside) / core::kDegree);
  const Columns columns(what, names);
  for (std::size_t row = 0; row < angles.size(); ++row) {
    std::vector<std::string> cells;
    for (const auto& of_surface : readings) cells.push_back(share_text(of_surface[row].reflectance()));
    cells.push_back(fmt::format(
        "{:.5f}", optics::fresnel(std::cos(angles[row]), index.inside, index.outside).unpolarised()));
    columns.row(angles[row] / core::kDegree, cells);
  }
}

void reflectance(const CompareOptions& options) {
  report::Plot plot = report::incidence_plot("Reflectance against incidence", "reflectance");
  for (const std::string& outside : options.outside) reflectance_into(options, outside, plot);
  write(options.reflectance, plot);
}

void directions(const CompareOptions& options) {
  const std::vector<analysis::SampleSurface> all =
      make_all(options, options.outside.front(), options.on_the_spot);
  analysis::GoniometerSettings settings = settings_of(options);
  settings.rays *= kDirectionFactor;
  settings.incidence_rad = angle_rad(options.angle);
  report::Plot plot = report::profile_plot("Reflected directions in the plane of incidence");
  plot.log_y = true;
  std::vector<analysis::GoniometerReading> readings;
  for (const analysis::SampleSurface& sample : all) {
    readings.push_back(analysis::read_goniometer(sample.surface, sample.index, settings));
    plot.series.push_back(
        report::profile_series(sample.place.surface, readings.back().reflected_directions, settings));
  }
  const Columns columns(
      fmt::format("reflected light (1/sr) within {:g} deg of the plane of incidence, into {}, "
                  "incidence {:g} deg",
                  settings.profile_half_width_rad / core::kDegree, options.outside.front(),
                  settings.incidence_rad / core::kDegree),
      options.surfaces);
  const double solid_angle = analysis::profile_bin_sr(settings.profile_half_width_rad);
  for (int bin = 0; bin < analysis::DirectionCounts::kProfileBins; ++bin) {
    std::vector<std::string> cells;
    for (const analysis::GoniometerReading& reading : readings)
      cells.push_back(share_text(analysis::density_per_sr(
          reading.reflected_directions.profile[static_cast<std::size_t>(bin)], settings.rays, solid_angle)));
    columns.row(analysis::profile_edge_deg(bin) + 0.5, cells);
  }
  write(options.directions, plot);
}

void run_compare(const CompareOptions& options) {
  const InterruptGuard guard;
  const analysis::SamplePlace place = place_of(options.sample, "", "");
  std::cout << fmt::format("inside       {}, {:g} nm, light from inside, seed {}\n", place.inside,
                           place.wavelength_nm, options.sample.seed);
  if (!options.slopes.empty()) slopes(options);
  if (!options.reflectance.empty()) reflectance(options);
  if (!options.directions.empty()) directions(options);
}

}  // namespace

void add_table_compare_command(CLI::App& table) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      table.add_subcommand("compare", "Draw surfaces of the material database in one plot, as SVG files");
  command->add_option("SURFACE", options->surfaces, "Surfaces of the material database, or of the scene")
      ->required();
  add_sample_options(*command, options->sample, kComparedRays);
  command
      ->add_option("--outside", options->outside,
                   "Medium outside; of several, the first is that of slopes and directions")
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--angle", options->angle, "Angle of incidence of the directions")
      ->capture_default_str();
  command->add_flag("--on-the-spot", options->on_the_spot,
                    "Trace rays on the height maps themselves instead of their tables");
  auto* slope_file =
      command->add_option("--slopes", options->slopes,
                          "SVG file for the mean visible slope, always on the height maps themselves");
  auto* reflectance_file = command->add_option("--reflectance", options->reflectance,
                                               "SVG file for reflectance against incidence");
  auto* direction_file = command->add_option("--directions", options->directions,
                                             "SVG file for the in-plane profile of reflected light");
  command->callback([=] {
    if (slope_file->empty() && reflectance_file->empty() && direction_file->empty())
      throw CLI::RequiredError("one at least of --slopes, --reflectance, --directions");
    run_compare(*options);
  });
}

}  // namespace scintray::cli
