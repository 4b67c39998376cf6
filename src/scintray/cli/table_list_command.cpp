#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <sstream>

#include "scintray/cli/goniometer_options.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/pages/pages.hpp"

namespace scintray::cli {

namespace {

constexpr std::uint64_t kListedRays = 50'000;
/// The profile requires more: its bins contain a few in ten thousand of the rays.
constexpr std::uint64_t kProfileFactor = 10;
constexpr double kStep_deg = 2.5, kProfile_deg = 45.0;
constexpr double kStated_deg[] = {0.0, 45.0, 80.0};

struct ListOptions {
  SampleOptions sample;
  std::string outside = "air", page;
  bool json = false;
};

std::vector<double> sweep_angles() {
  std::vector<double> angles;
  for (double angle = 0.0; angle < 90.0; angle += kStep_deg) angles.push_back(angle * core::kDegree);
  return angles;
}

report::SurfaceReadings read_surface(analysis::SampleSurface sample, const SampleOptions& options) {
  analysis::GoniometerSettings settings;
  settings.wavelength_nm = sample.place.wavelength_nm;
  settings.rays = options.rays;
  settings.seed = options.seed;
  settings.stop = [] { return InterruptGuard::requested().load(); };
  report::SurfaceReadings readings;
  const std::vector<double> angles = sweep_angles();
  readings.sweep = analysis::sweep_incidence(sample.surface, sample.index, settings, angles);
  settings.stream = angles.size();
  settings.incidence_rad = kProfile_deg * core::kDegree;
  settings.rays *= kProfileFactor;
  readings.profile = analysis::read_goniometer(sample.surface, sample.index, settings);
  readings.sample = std::move(sample);
  return readings;
}

report::SurfaceEntry make_entry(const std::string& name, const materials::MaterialDatabase& database,
                                materials::SurfaceFactory& factory, const ListOptions& options) {
  report::SurfaceEntry entry;
  entry.name = name;
  entry.outline = database.outline(name);
  if (!entry.outline.needs.empty()) return entry;
  try {
    entry.readings = read_surface(
        analysis::make_sample_surface(database, factory, place_of(options.sample, name, options.outside)),
        options.sample);
  } catch (const core::InputError& error) {
    entry.not_made = error.problems().front().what;
  }
  return entry;
}

std::string reflectance_at(const report::SurfaceReadings& readings, double degrees) {
  for (const analysis::GoniometerReading& reading : readings.sweep)
    if (std::abs(reading.settings.incidence_rad - degrees * core::kDegree) < 1e-9)
      return share_text(reading.reflectance());
  throw core::InternalError("an angle that is not in the sweep");
}

void print_wrapped(const std::string& words) {
  constexpr std::size_t kWidth = 96;
  std::istringstream stream(words);
  std::string row;
  for (std::string word; stream >> word; row += (row.empty() ? "" : " ") + word)
    if (row.size() + word.size() > kWidth) {
      std::cout << "    " << row << "\n";
      row.clear();
    }
  std::cout << "    " << row << "\n";
}

void print_entry(const report::SurfaceEntry& entry) {
  std::cout << "\n" << entry.name << "\n    model " << entry.outline.model;
  for (const std::string& base : entry.outline.bases) std::cout << ", based on " << base;
  std::cout << "\n";
  for (const std::string& source : entry.outline.sources) print_wrapped(source);
  if (!entry.outline.needs.empty())
    print_wrapped("required parameters: " + core::list_of(entry.outline.needs));
  if (!entry.not_made.empty()) print_wrapped("not made here: " + entry.not_made);
  if (!entry.readings) return;
  std::cout << "    reflected";
  for (const double degrees : kStated_deg)
    std::cout << fmt::format("   {:g} deg {}", degrees, reflectance_at(*entry.readings, degrees));
  std::cout << "\n";
}

Json entry_json(const report::SurfaceEntry& entry) {
  Json json = {{"surface", entry.name},        {"model", entry.outline.model},
               {"bases", entry.outline.bases}, {"sources", entry.outline.sources},
               {"needs", entry.outline.needs}, {"not_made", entry.not_made},
               {"reflectance", Json::array()}};
  if (entry.readings)
    for (const analysis::GoniometerReading& reading : entry.readings->sweep)
      json["reflectance"].push_back(
          {{"incidence_deg", json_of(reading.settings.incidence_rad / core::kDegree)},
           {"value", json_of(reading.reflectance().value)},
           {"error", json_of(reading.reflectance().error)}});
  return json;
}

void run_list(const ListOptions& options) {
  const JsonAnswer answer(options.json);
  const InterruptGuard guard;
  ProgressLine line(true);
  const ActivityWatch watch(line);
  materials::SurfaceFactory factory = watched_factory(line);
  const materials::MaterialDatabase database = database_of(options.sample);
  const analysis::SamplePlace place = place_of(options.sample, "", options.outside);
  database.medium(place.inside);  // an error here is reported once, not for each surface
  database.medium(place.outside);
  const std::string under =
      fmt::format("{} to {}, {:g} nm, light from inside", place.inside, place.outside, place.wavelength_nm);
  std::cout << "surfaces     " << under << "\n";
  std::vector<report::SurfaceEntry> entries;
  for (const std::string& name : database.names(materials::DefinitionKind::surface)) {
    entries.push_back(make_entry(name, database, factory, options));
    line.clear();
    print_entry(entries.back());
  }
  answer.print([&] {
    Json list = Json::array();
    for (const report::SurfaceEntry& entry : entries) list.push_back(entry_json(entry));
    return Json{{"surfaces", list}};
  });
  if (options.page.empty()) return;
  report::write_page(options.page, report::surface_page(entries, under));
  std::cout << "\nwritten      " << options.page << "\n";
}

}  // namespace

void add_table_list_command(CLI::App& table) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = table.add_subcommand(
      "list", "Print every surface of the material database, and show them side by side");
  add_sample_options(*command, options->sample, kListedRays);
  command->add_option("--outside", options->outside, "Medium outside")->capture_default_str();
  command->add_option("--page", options->page, "HTML page to write");
  add_json_flag(*command, options->json);
  command->footer("Example: scintray table list --inside LSO --outside air --page surfaces.html");
  command->callback([options] { run_list(*options); });
}

}  // namespace scintray::cli
