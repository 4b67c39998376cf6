#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "scintray/analysis/goniometer/measured_profile.hpp"
#include "scintray/cli/goniometer_options.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/word_option.hpp"
#include "scintray/core/error.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/pages/pages.hpp"

namespace scintray::cli {

namespace {

constexpr std::uint64_t kRays = 1'000'000;

struct GoniometerOptions {
  SampleOptions sample;
  std::string surface, outside = "air", half_width = "5 deg", measured, page, csv, cells;
  optics::Side side = optics::Side::inside;
  std::vector<std::string> angles;
  bool on_the_spot = false;
  bool json = false;
};

void print_lobe(const char* light, const analysis::Lobe& lobe) {
  if (lobe.rays == 0) return;
  const auto degrees = [](double sine) { return std::asin(std::min(1.0, sine)) / core::kDegree; };
  std::cout << fmt::format("  {:<12} {:>9.3f} +- {:.3f} {:>9.3f} +- {:.3f} {:>12.3f} {:>12.3f}\n", light,
                           lobe.in_plane_rad.value / core::kDegree, lobe.in_plane_rad.error / core::kDegree,
                           lobe.across_rad.value / core::kDegree, lobe.across_rad.error / core::kDegree,
                           degrees(lobe.width_in_plane), degrees(lobe.width_across));
}

void print_readings(const std::vector<analysis::GoniometerReading>& readings) {
  std::cout << fmt::format("\n{:>13}{:>21}{:>21}{:>21}\n", "incidence deg", "reflected", "transmitted",
                           "absorbed");
  for (const analysis::GoniometerReading& r : readings)
    std::cout << fmt::format("{:>13.3f}{:>21}{:>21}{:>21}\n", r.settings.incidence_rad / core::kDegree,
                             share_text(r.reflectance()), share_text(r.transmittance()),
                             share_text(r.absorptance()));
  for (const analysis::GoniometerReading& r : readings) {
    std::cout << fmt::format("\nincidence {:g} deg, directions in deg\n",
                             r.settings.incidence_rad / core::kDegree);
    std::cout << fmt::format("  {:<12} {:>18} {:>18} {:>12} {:>12}\n", "light", "mean in plane",
                             "mean across", "rms in plane", "rms across");
    print_lobe("reflected", r.reflected_lobe);
    print_lobe("transmitted", r.transmitted_lobe);
  }
}

Json lobe_json(const analysis::Lobe& lobe) {
  if (lobe.rays == 0) return nullptr;
  const auto degrees = [](const core::Estimate& angle) {
    return json_of(core::Estimate{angle.value / core::kDegree, angle.error / core::kDegree});
  };
  return {{"rays", lobe.rays},
          {"in_plane_deg", degrees(lobe.in_plane_rad)},
          {"across_deg", degrees(lobe.across_rad)},
          {"rms_sine_in_plane", json_of(lobe.width_in_plane)},
          {"rms_sine_across", json_of(lobe.width_across)}};
}

Json readings_json(const std::vector<analysis::GoniometerReading>& readings) {
  Json list = Json::array();
  for (const analysis::GoniometerReading& r : readings)
    list.push_back({{"incidence_deg", json_of(r.settings.incidence_rad / core::kDegree)},
                    {"rays", r.settings.rays},
                    {"reflectance", json_of(r.reflectance())},
                    {"transmittance", json_of(r.transmittance())},
                    {"absorptance", json_of(r.absorptance())},
                    {"reflected", lobe_json(r.reflected_lobe)},
                    {"transmitted", lobe_json(r.transmitted_lobe)}});
  return {{"readings", list}};
}

/// In-plane profiles of all readings. ScintRay's reader skips lines that start with #.
std::string profile_csv(const analysis::SampleSurface& sample,
                        const std::vector<analysis::GoniometerReading>& readings) {
  const analysis::GoniometerSettings& s = readings.front().settings;
  std::string out = fmt::format("# {}, {}; within {:g} deg of the plane of incidence; densities in 1/sr\n",
                                sample.place.surface, report::sample_text(sample, s.side),
                                s.profile_half_width_rad / core::kDegree);
  out += "incidence_deg,angle_deg,reflected,reflected_error,transmitted,transmitted_error\n";
  const double solid_angle = analysis::profile_bin_sr(s.profile_half_width_rad);
  for (const analysis::GoniometerReading& r : readings)
    for (int k = 0; k < analysis::DirectionCounts::kProfileBins; ++k) {
      const auto bin = static_cast<std::size_t>(k);
      const core::Estimate back =
          analysis::density_per_sr(r.reflected_directions.profile[bin], s.rays, solid_angle);
      const core::Estimate on =
          analysis::density_per_sr(r.transmitted_directions.profile[bin], s.rays, solid_angle);
      out += fmt::format("{:g},{:g},{:.6g},{:.3g},{:.6g},{:.3g}\n", r.settings.incidence_rad / core::kDegree,
                         analysis::profile_edge_deg(k) + 0.5, back.value, back.error, on.value, on.error);
    }
  return out;
}

std::string cell_csv(const analysis::SampleSurface& sample,
                     const std::vector<analysis::GoniometerReading>& readings) {
  const analysis::GoniometerSettings& s = readings.front().settings;
  std::string out = fmt::format("# {}, {}; {} rays an incidence\n", sample.place.surface,
                                report::sample_text(sample, s.side), s.rays);
  out +=
      "incidence_deg,polar_low_deg,polar_high_deg,azimuth_low_deg,azimuth_high_deg,solid_angle_sr,"
      "reflected_rays,transmitted_rays\n";
  for (const analysis::GoniometerReading& r : readings)
    for (std::size_t k = 0; k < analysis::hemisphere_grid().size(); ++k) {
      const analysis::HemisphereGrid::Cell cell = analysis::hemisphere_grid().cell(k);
      out += fmt::format("{:g},{:g},{:g},{:.6g},{:.6g},{:.6g},{},{}\n",
                         r.settings.incidence_rad / core::kDegree, cell.polar_low / core::kDegree,
                         cell.polar_high / core::kDegree, cell.azimuth_low / core::kDegree,
                         cell.azimuth_high / core::kDegree, cell.solid_angle_sr,
                         r.reflected_directions.cells[k], r.transmitted_directions.cells[k]);
    }
  return out;
}

void write(const std::string& path, const std::string& content) {
  report::write_page(path, content);
  std::cout << "written      " << path << "\n";
}

void run_goniometer(const GoniometerOptions& options) {
  const JsonAnswer answer(options.json);
  analysis::GoniometerSettings settings;
  settings.side = options.side;
  settings.rays = options.sample.rays;
  settings.seed = options.sample.seed;
  settings.profile_half_width_rad = angle_rad(options.half_width);
  std::vector<double> angles;
  for (const std::string& angle : options.angles) angles.push_back(angle_rad(angle));
  std::optional<analysis::MeasuredProfile> measured;
  if (!options.measured.empty()) {
    if (angles.size() > 1)
      throw core::InputError({{},
                              fmt::format("--measured with {} angles; expected one", angles.size()),
                              "a measurement belongs to one incidence: run the command once for each"});
    measured = analysis::read_measured_profile(options.measured);
  }

  const InterruptGuard guard;
  ProgressLine line(true);
  const ActivityWatch watch(line);
  materials::SurfaceFactory factory = watched_factory(line);
  const analysis::SamplePlace place = place_of(options.sample, options.surface, options.outside);
  settings.wavelength_nm = place.wavelength_nm;
  materials::MaterialDatabase database = database_of(options.sample);
  add_file_surface(database, options.surface);
  const analysis::SampleSurface sample =
      analysis::make_sample_surface(database, factory, place, options.on_the_spot);
  settings.stop = [] { return InterruptGuard::requested().load(); };
  const auto readings = analysis::sweep_incidence(sample.surface, sample.index, settings, angles);
  line.clear();

  std::cout << fmt::format(
      "surface      {}\nbetween      {}\nrays         {} an angle, seed {}, unpolarised\n", options.surface,
      report::sample_text(sample, settings.side), settings.rays, settings.seed);
  for (const std::string& warning : sample.warnings) std::cout << "warning: " << warning << "\n";
  print_readings(readings);
  answer.print([&] { return readings_json(readings); });
  std::optional<report::Overlay> overlay;
  if (measured) {
    overlay = report::Overlay{analysis::scale_to(*measured, readings.front().reflected_directions,
                                                 settings.rays, settings.profile_half_width_rad),
                              std::filesystem::path(options.measured).filename().string()};
    std::cout << "\nmeasured     " << report::overlay_text(*overlay) << "\n";
  }
  if (!options.csv.empty()) write(options.csv, profile_csv(sample, readings));
  if (!options.cells.empty()) write(options.cells, cell_csv(sample, readings));
  if (!options.page.empty()) write(options.page, report::goniometer_page(sample, readings, overlay));
}

}  // namespace

void add_goniometer_command(CLI::App& app) {
  auto options = std::make_shared<GoniometerOptions>();
  CLI::App* command = app.add_subcommand(
      "goniometer",
      "Measure the directions of light from a surface of the material database with a parallel beam");
  command
      ->add_option("SURFACE", options->surface,
                   "Surface of the material database or of the scene, or file of a table (.h5) or height map")
      ->required();
  command->add_option("--angle", options->angles, "Angle of incidence, as \"45 deg\"; several are allowed")
      ->required()
      ->allow_extra_args(false);
  add_sample_options(*command, options->sample, kRays);
  command->add_option("--outside", options->outside, "Medium outside")->capture_default_str();
  add_word_option(*command, "--side", options->side, kSideWords, "Side of the incident light")
      ->default_str(core::word_of(kSideWords, options->side));
  command
      ->add_option("--half-width", options->half_width,
                   "Half-width of the in-plane profile, out of the plane of incidence")
      ->capture_default_str();
  command->add_flag("--on-the-spot", options->on_the_spot,
                    "Trace rays on the height map itself instead of its table");
  command->add_option("--measured", options->measured,
                      "CSV file with a measured in-plane profile: angle_deg, value and optionally error");
  command->add_option("-o,--output", options->page, "HTML page to write");
  command->add_option("--csv", options->csv, "CSV file for the in-plane profiles");
  command->add_option("--cells", options->cells, "CSV file for the counts over the hemisphere");
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray goniometer lso_ground_30um --angle \"45 deg\" -o page.html\n"
      "  scintray goniometer polished_esr_air --angle \"0 deg\" --angle \"60 deg\" --json");
  command->callback([options] { run_goniometer(*options); });
}

}  // namespace scintray::cli
