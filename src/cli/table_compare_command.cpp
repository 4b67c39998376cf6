#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "scintray/cli/bench_options.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/table_command.hpp"
#include "scintray/report/goniometer_page.hpp"
#include "scintray/report/goniometer_plots.hpp"
#include "scintray/report/page.hpp"
#include "scintray/surface/fresnel.hpp"

namespace scintray::cli {

namespace {

constexpr std::uint64_t kRays = 200'000;
/// Of the directions: their bins hold a few in ten thousand of the rays.
constexpr std::uint64_t kDirectionFactor = 10;

struct Options {
  BenchOptions bench;
  std::vector<std::string> surfaces, outside{"air"};
  std::string angle = "45 deg", slopes, reflectance, directions;
};

/// Steps of 2.5 deg, and 88.5 deg, at which grazing slopes of recipes are stated.
std::vector<double> incidences() {
  std::vector<double> angles;
  for (double angle = 0.0; angle < 88.0; angle += 2.5) angles.push_back(angle * kDegree);
  angles.push_back(88.5 * kDegree);
  return angles;
}

/// Surfaces by name between the inside medium and each outside one.
struct Bench {
  std::string label;
  BenchSurface surface;
};

std::vector<Bench> make_all(const Options& options, bool on_the_spot,
                            const std::vector<std::string>& outside) {
  ProgressLine line(true);
  SurfaceMaker maker = watched_maker(line);
  const Library library = library_of(options.bench);
  std::vector<Bench> all;
  for (const std::string& medium : outside)
    for (const std::string& name : options.surfaces)
      all.push_back({outside.size() > 1 ? name + ", " + medium : name,
                     make_bench_surface(library, maker, place_of(options.bench, name, medium), on_the_spot)});
  return all;
}

void print_heading(const std::string& what, const std::vector<Bench>& all) {
  std::cout << "\n" << what << "\n" << fmt::format("{:>10}", "deg");
  for (const Bench& bench : all) std::cout << fmt::format("  {:>22}", bench.label);
  std::cout << "\n";
}

void write(const std::string& path, const report::Plot& plot) {
  report::write_page(path, report::svg_file(plot));
  std::cout << "written      " << path << "\n";
}

void slopes(const Options& options) {
  const std::vector<Bench> all = make_all(options, true, {options.outside.front()});
  print_heading("mean slope met from inside (deg) against incidence", all);
  report::Plot plot = report::incidence_plot("Mean slope met against incidence", "mean slope met (deg)");
  for (const Bench& bench : all) plot.series.push_back({bench.label, {}, {}, {}});
  for (const double angle : incidences()) {
    std::cout << fmt::format("{:>10.2f}", angle / kDegree);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Estimate slope = mean_slope_met(all[k].surface.surface, Side::inside, angle);
      std::cout << fmt::format("  {:>12.3f} +- {:.3f}", slope.value / kDegree, slope.error / kDegree);
      plot.series[k].x.push_back(angle / kDegree);
      plot.series[k].y.push_back(slope.value / kDegree);
      plot.series[k].error.push_back(slope.error / kDegree);
    }
    std::cout << "\n";
  }
  write(options.slopes, plot);
}

void reflectance(const Options& options) {
  const std::vector<Bench> all = make_all(options, false, options.outside);
  GoniometerSettings settings;
  settings.rays = options.bench.rays;
  settings.seed = options.bench.seed;
  settings.wavelength_nm = all.front().surface.place.wavelength_nm;
  const std::vector<double> angles = incidences();
  report::Plot plot = report::incidence_plot("Reflectance against incidence", "reflectance");
  plot.y_high = 1.0;
  std::vector<std::vector<GoniometerReading>> readings;
  for (const Bench& bench : all) {
    readings.push_back(sweep_incidence(bench.surface.surface, bench.surface.index, settings, angles));
    plot.series.push_back(report::reflectance_series(bench.label, readings.back()));
  }
  print_heading("reflectance from inside against incidence, with Fresnel's below each", all);
  for (std::size_t row = 0; row < angles.size(); ++row) {
    std::cout << fmt::format("{:>10.2f}", angles[row] / kDegree);
    for (const auto& of_surface : readings)
      std::cout << fmt::format("  {:>22}", share_text(of_surface[row].reflectance()));
    std::cout << fmt::format("\n{:>10}", "Fresnel");
    for (const Bench& bench : all)
      std::cout << fmt::format(
          "  {:>11.5f}{:11}",
          fresnel(std::cos(angles[row]), bench.surface.index.inside, bench.surface.index.outside)
              .unpolarised(),
          "");
    std::cout << "\n";
  }
  for (std::size_t k = 0; k < options.outside.size(); ++k) {
    const IndexPair index = all[k * options.surfaces.size()].surface.index;
    plot.series.push_back(
        report::fresnel_series("Fresnel, " + options.outside[k], index.inside, index.outside));
    if (index.inside > index.outside)
      std::cout << fmt::format("critical angle to {}: {:.2f} deg\n", options.outside[k],
                               std::asin(index.outside / index.inside) / kDegree);
  }
  write(options.reflectance, plot);
}

void directions(const Options& options) {
  const std::vector<Bench> all = make_all(options, false, {options.outside.front()});
  GoniometerSettings settings;
  settings.rays = kDirectionFactor * options.bench.rays;
  settings.seed = options.bench.seed;
  settings.wavelength_nm = all.front().surface.place.wavelength_nm;
  settings.incidence_rad = angle_rad(options.angle);
  report::Plot plot = report::profile_plot("Reflected directions in the plane of incidence");
  plot.log_y = true;
  std::vector<GoniometerReading> readings;
  for (const Bench& bench : all) {
    readings.push_back(read_goniometer(bench.surface.surface, bench.surface.index, settings));
    plot.series.push_back(
        report::profile_series(bench.label, readings.back().reflected_directions, settings));
  }
  print_heading(
      fmt::format("reflected light per sr against the angle in the plane of incidence, incidence {}",
                  options.angle),
      all);
  const double solid_angle = profile_bin_sr(settings.profile_half_width_rad);
  for (std::size_t bin = 0; bin < DirectionCounts::kProfileBins; ++bin) {
    std::cout << fmt::format("{:>10.1f}", profile_edge_deg(static_cast<int>(bin)) + 0.5);
    for (const GoniometerReading& reading : readings) {
      const Estimate value =
          density_per_sr(reading.reflected_directions.profile[bin], settings.rays, solid_angle);
      std::cout << fmt::format("  {:>11.5f} +- {:.5f}", value.value, value.error);
    }
    std::cout << "\n";
  }
  write(options.directions, plot);
}

void run(const Options& options) {
  const InterruptGuard guard;
  const BenchPlace place = place_of(options.bench, "", "");
  std::cout << fmt::format("inside       {}, {:g} nm, light from inside, seed {}\n", place.inside,
                           place.wavelength_nm, options.bench.seed);
  if (!options.slopes.empty()) slopes(options);
  if (!options.reflectance.empty()) reflectance(options);
  if (!options.directions.empty()) directions(options);
}

}  // namespace

void add_table_compare_command(CLI::App& table) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      table.add_subcommand("compare", "Draw surfaces of the library in one plot, as SVG files");
  command->add_option("SURFACE", options->surfaces, "Surfaces of the library, or of the scene")->required();
  add_bench_options(*command, options->bench, kRays);
  command
      ->add_option("--outside", options->outside,
                   "Medium outside; of several, the first is that of slopes and directions")
      ->capture_default_str();
  command->add_option("--angle", options->angle, "Angle of incidence of the directions")
      ->capture_default_str();
  auto* slope_file = command->add_option("--slopes", options->slopes, "SVG file for the mean slope met");
  auto* reflectance_file = command->add_option("--reflectance", options->reflectance,
                                               "SVG file for reflectance against incidence");
  auto* direction_file = command->add_option("--directions", options->directions,
                                             "SVG file for the in-plane profile of reflected light");
  command->callback([=] {
    if (slope_file->empty() && reflectance_file->empty() && direction_file->empty())
      throw CLI::RequiredError("one at least of --slopes, --reflectance, --directions");
    run(*options);
  });
}

}  // namespace scintray::cli
