#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "scintray/cli/goniometer_options.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
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
  bool json = false;
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
  const ActivityWatch watch(line);
  materials::SurfaceFactory factory = watched_factory(line);
  const materials::MaterialDatabase database = database_of(options.sample);
  std::vector<analysis::SampleSurface> all;
  for (const std::string& name : options.surfaces)
    all.push_back(analysis::make_sample_surface(database, factory, place_of(options.sample, name, outside),
                                                on_the_spot));
  return all;
}

/// Rows of numbers, a column for each surface, printed and kept as JSON.
class Columns {
 public:
  Columns(const std::string& what, const std::vector<std::string>& names)
      : json_({{"what", what}, {"columns", names}, {"rows", Json::array()}}) {
    std::cout << "\n" << what << "\n" << fmt::format("{:>8}", "deg");
    for (const std::string& name : names) {
      widths_.push_back(std::max<std::size_t>(21, name.size()) + 2);
      std::cout << fmt::format("{:>{}}", name, widths_.back());
    }
    std::cout << "\n";
  }
  void row(double degrees, const std::vector<core::Estimate>& values, const std::vector<std::string>& cells) {
    Json row = {{"deg", json_of(degrees)}, {"values", Json::array()}};
    for (const core::Estimate& value : values) row["values"].push_back(json_of(value));
    json_["rows"].push_back(std::move(row));
    std::cout << fmt::format("{:>8.2f}", degrees);
    for (std::size_t k = 0; k < cells.size(); ++k) std::cout << fmt::format("{:>{}}", cells[k], widths_[k]);
    std::cout << "\n";
  }

  const Json& json() const { return json_; }

 private:
  Json json_;
  std::vector<std::size_t> widths_;
};

analysis::GoniometerSettings settings_of(const CompareOptions& options) {
  analysis::GoniometerSettings settings;
  settings.rays = options.sample.rays;
  settings.seed = options.sample.seed;
  settings.wavelength_nm = place_of(options.sample, "", "").wavelength_nm;
  settings.stop = [] { return InterruptGuard::requested().load(); };
  return settings;
}

void write(const std::string& path, const report::Plot& plot) {
  report::write_page(path, report::svg_file(plot));
  std::cout << "written      " << path << "\n";
}

Json slopes(const CompareOptions& options) {
  const std::vector<analysis::SampleSurface> all = make_all(options, options.outside.front(), true);
  Columns columns("mean visible slope from inside (deg) against incidence", options.surfaces);
  report::Plot plot =
      report::incidence_plot("Mean visible slope against incidence", "mean visible slope (deg)");
  plot.series.resize(all.size());
  for (const double angle : incidences()) {
    std::vector<std::string> cells;
    std::vector<core::Estimate> values;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const core::Estimate slope = analysis::mean_visible_slope(all[k].surface, optics::Side::inside, angle);
      values.push_back({slope.value / core::kDegree, slope.error / core::kDegree});
      cells.push_back(
          fmt::format("{:.3f} +- {:.3f}", slope.value / core::kDegree, slope.error / core::kDegree));
      report::PlotSeries& series = plot.series[k];
      series.label = options.surfaces[k];
      series.x.push_back(angle / core::kDegree);
      series.y.push_back(slope.value / core::kDegree);
    }
    columns.row(angle / core::kDegree, values, cells);
  }
  write(options.slopes, plot);
  return columns.json();
}

/// Prints reflectances into one medium, and adds them to the plot.
Json reflectance_into(const CompareOptions& options, const std::string& outside, report::Plot& plot) {
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
  Columns columns(what, names);
  for (std::size_t row = 0; row < angles.size(); ++row) {
    std::vector<std::string> cells;
    std::vector<core::Estimate> values;
    for (const auto& of_surface : readings) values.push_back(of_surface[row].reflectance());
    for (const core::Estimate& value : values) cells.push_back(share_text(value));
    const double fresnel = optics::fresnel(std::cos(angles[row]), index.inside, index.outside).unpolarised();
    values.push_back({fresnel, 0.0});
    cells.push_back(fmt::format("{:.5f}", fresnel));
    columns.row(angles[row] / core::kDegree, values, cells);
  }
  return columns.json();
}

Json reflectance(const CompareOptions& options) {
  Json tables = Json::array();
  report::Plot plot = report::incidence_plot("Reflectance against incidence", "reflectance");
  for (const std::string& outside : options.outside)
    tables.push_back(reflectance_into(options, outside, plot));
  write(options.reflectance, plot);
  return tables;
}

Json directions(const CompareOptions& options) {
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
  Columns columns(fmt::format("reflected light (1/sr) within {:g} deg of the plane of incidence, into {}, "
                              "incidence {:g} deg",
                              settings.profile_half_width_rad / core::kDegree, options.outside.front(),
                              settings.incidence_rad / core::kDegree),
                  options.surfaces);
  const double solid_angle = analysis::profile_bin_sr(settings.profile_half_width_rad);
  for (int bin = 0; bin < analysis::DirectionCounts::kProfileBins; ++bin) {
    std::vector<std::string> cells;
    std::vector<core::Estimate> values;
    for (const analysis::GoniometerReading& reading : readings)
      values.push_back(analysis::density_per_sr(
          reading.reflected_directions.profile[static_cast<std::size_t>(bin)], settings.rays, solid_angle));
    for (const core::Estimate& value : values) cells.push_back(share_text(value));
    columns.row(analysis::profile_edge_deg(bin) + 0.5, values, cells);
  }
  write(options.directions, plot);
  return columns.json();
}

void run_compare(const CompareOptions& options) {
  const JsonAnswer answer(options.json);
  const InterruptGuard guard;
  const analysis::SamplePlace place = place_of(options.sample, "", "");
  std::cout << fmt::format("inside       {}, {:g} nm, light from inside, seed {}\n", place.inside,
                           place.wavelength_nm, options.sample.seed);
  Json tables = Json::object();
  if (!options.slopes.empty()) tables["slopes"] = slopes(options);
  if (!options.reflectance.empty()) tables["reflectance"] = reflectance(options);
  if (!options.directions.empty()) tables["directions"] = directions(options);
  answer.print([&] { return tables; });
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
  add_json_flag(*command, options->json);
  command->footer(
      "Example: scintray table compare lso_ground_30um polished --inside LSO --reflectance lso.svg");
  command->callback([=] {
    if (slope_file->empty() && reflectance_file->empty() && direction_file->empty())
      throw CLI::RequiredError("one at least of --slopes, --reflectance, --directions");
    run_compare(*options);
  });
}

}  // namespace scintray::cli
