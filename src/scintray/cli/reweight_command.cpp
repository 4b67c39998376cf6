#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <string>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/version.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/results/results.hpp"
#include "scintray/simulation/reweight.hpp"

namespace scintray::cli {

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> items_of(const std::string& list) {
  std::vector<std::string> items;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    items.push_back(trimmed(list.substr(start, end - start)));
    start = end + 1;
  }
  return items;
}

/// Word for no absorption, in place of a length.
constexpr const char* kNoAbsorption = "none";

/// The text after the number at the start of `item`.
std::string unit_of(const std::string& item) {
  char* end = nullptr;
  std::strtod(item.c_str(), &end);
  return trimmed(end);
}

/// "LSO=200 mm", "LSO=100,200,400 mm", "LSO=100 mm,none", "LSO=x0.5,x2"; "PTFE=0.95", "PTFE=90,95 %",
/// "PTFE=x0.98".
/// @param option  for messages: "--reflectance"
/// @throws CLI::ValidationError for other forms; the range of values is not yet checked
simulation::PropertyScan parse_scan(const std::string& option, simulation::OpticalProperty property,
                                    const std::string& text) {
  const bool length = property == simulation::OpticalProperty::absorption_length;
  const auto refuse = [&](const std::string& what) {
    return CLI::ValidationError(option, "\"" + text + "\": " + what + "; write " +
                                            (length ? "\"LSO=200 mm\", \"LSO=100,200 mm,none\" or \"LSO=x2\""
                                                    : "\"PTFE=0.95\", \"PTFE=0.9,0.95\" or \"PTFE=x0.98\""));
  };
  simulation::PropertyScan scan;
  scan.property = property;
  const std::size_t equals = text.rfind('=');
  scan.name = trimmed(text.substr(0, std::min(equals, text.size())));
  if (equals == std::string::npos || scan.name.empty()) throw refuse("no name before a \"=\"");
  const std::vector<std::string> items = items_of(text.substr(equals + 1));
  scan.times = items.front().starts_with("x");
  std::string unit;  // for items without a unit: the last one given
  for (const std::string& item : items)
    if (item != kNoAbsorption && !unit_of(item).empty()) unit = unit_of(item);
  for (std::string item : items) {
    if (item.starts_with("x") != scan.times) throw refuse("factors and values are mixed");
    if (length && item == kNoAbsorption && !scan.times) {
      scan.values.push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    if (scan.times) item.erase(0, 1);
    if (!scan.times && unit_of(item).empty() && !unit.empty()) item += " " + unit;
    try {
      const bool is_length = length && !scan.times;
      scan.values.push_back(
          core::parse_quantity(item, is_length ? core::Dimension::length : core::Dimension::dimensionless));
    } catch (const core::InputError& error) {
      throw refuse(error.problems().front().what);
    }
  }
  return scan;
}

struct ReweightOptions {
  std::filesystem::path results, output;
  std::vector<std::string> lengths, reflectances;
  bool json = false;
};

std::vector<simulation::PropertyScan> scans_of(const ReweightOptions& options) {
  std::vector<simulation::PropertyScan> scans;
  for (const std::string& text : options.lengths)
    scans.push_back(parse_scan("--absorption-length", simulation::OpticalProperty::absorption_length, text));
  for (const std::string& text : options.reflectances)
    scans.push_back(parse_scan("--reflectance", simulation::OpticalProperty::reflectance, text));
  if (scans.empty())
    throw CLI::ValidationError("reweight",
                               "no property to change; use --absorption-length \"LSO=200 mm\" or "
                               "--reflectance \"PTFE=0.95\"");
  return scans;
}

std::string setting_text(const std::vector<simulation::PropertyScan>& scans,
                         const simulation::ReweightedPoint& point) {
  std::string text;
  for (std::size_t i = 0; i < scans.size(); ++i)
    text += (i == 0 ? "" : ", ") + describe(scans[i]) + " " +
            simulation::describe_value(scans[i], point.values[i]);
  return text;
}

void print(const tally::RunResult& run, const std::vector<simulation::PropertyScan>& scans,
           const std::vector<simulation::ReweightedPoint>& points) {
  std::size_t last = run.points.size();
  for (const simulation::ReweightedPoint& point : points) {
    if (point.point != last) {
      if (run.points.size() > 1) std::cout << report::point_label(run.points[point.point]) << "\n";
      std::cout << "as traced: detected " << report::percent_with_error(point.traced_fraction);
      if (point.traced_per_event)
        std::cout << ", " << report::with_error(*point.traced_per_event) << " per event";
      std::cout << "\n";
      last = point.point;
    }
    const analysis::Reweighted& light = point.light;
    std::cout << setting_text(scans, point) << ": detected "
              << report::percent_with_error(light.detected_fraction);
    if (point.per_event) std::cout << ", " << report::with_error(*point.per_event) << " per event";
    std::cout << ", " << report::with_error(light.relative) << " of the traced light; "
              << fmt::format("{:.0f} effective photons ({:.0f} %)", light.effective_photons,
                             100.0 * light.effective_share)
              << "; " << (light.valid ? "valid" : "NOT VALID: " + light.reason) << "\n";
  }
  std::cout << report::omission_sentence(report::omitted_anywhere(run), report::Figure::fraction) << "\n";
}

Json json_of_points(const tally::RunResult& run, const std::vector<simulation::PropertyScan>& scans,
                    const std::vector<simulation::ReweightedPoint>& points) {
  Json list = Json::array();
  for (const simulation::ReweightedPoint& point : points) {
    Json values = Json::object();
    for (std::size_t i = 0; i < scans.size(); ++i)
      values[describe(scans[i])] = simulation::describe_value(scans[i], point.values[i]);
    const analysis::Reweighted& light = point.light;
    list.push_back({{"point", point.point},
                    {"parameters", run.points[point.point].parameters},
                    {"values", values},
                    {"traced_fraction", json_of(point.traced_fraction)},
                    {"fraction", json_of(light.detected_fraction)},
                    {"relative", json_of(light.relative)},
                    {"per_event", point.per_event ? json_of(*point.per_event) : Json(nullptr)},
                    {"effective_photons", json_of(light.effective_photons)},
                    {"valid", light.valid},
                    {"reason", light.reason},
                    {"not_included", Json::parse(report::omissions_json(run.points[point.point].omitted))}});
  }
  return {{"points", list}};
}

/// A field of a CSV file (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string estimate_fields(const core::Estimate& estimate) {
  return fmt::format(",{:.9g},{:.4g}", estimate.value, estimate.error);
}

std::string column_name(const simulation::PropertyScan& scan) {
  const bool length = scan.property == simulation::OpticalProperty::absorption_length;
  return describe(scan) + (scan.times ? " (factor)" : length ? " (mm)" : "");
}

std::string csv_of(const ReweightOptions& options, const tally::RunResult& run,
                   const std::vector<simulation::PropertyScan>& scans,
                   const std::vector<simulation::ReweightedPoint>& points) {
  std::string text = fmt::format(
      "# {}\n# reweighted by ScintRay {} from {}, which ScintRay {} traced of {}, seed {}\n# {}\n",
      run.header.title, core::version(), options.results.filename().string(), run.header.version,
      run.header.scene_file, run.header.seed,
      report::omission_sentence(report::omitted_anywhere(run), report::Figure::fraction));
  text += "point";
  for (const std::string& key : run.header.sweep_keys) text += "," + csv_field(key);
  for (const simulation::PropertyScan& scan : scans) text += "," + csv_field(column_name(scan));
  text +=
      ",traced_fraction,traced_fraction_error,fraction,fraction_error,relative,relative_error,"
      "traced_per_event,traced_per_event_error,per_event,per_event_error,effective_photons,"
      "effective_share,largest_share,tail_shape,valid,reason\n";
  for (const simulation::ReweightedPoint& point : points) {
    const analysis::Reweighted& light = point.light;
    text += std::to_string(point.point);
    for (const std::string& value : run.points[point.point].parameters) text += "," + csv_field(value);
    for (const double value : point.values) text += fmt::format(",{:.9g}", value);
    text += estimate_fields(point.traced_fraction) + estimate_fields(light.detected_fraction) +
            estimate_fields(light.relative);
    text += point.per_event ? estimate_fields(*point.traced_per_event) + estimate_fields(*point.per_event)
                            : std::string(",,,,");
    text +=
        fmt::format(",{:.6g},{:.4g},{:.4g},{:.4g},{},{}\n", light.effective_photons, light.effective_share,
                    light.largest_share, light.tail_shape, light.valid ? 1 : 0, csv_field(light.reason));
  }
  return text;
}

void reweight(const ReweightOptions& options) {
  const JsonAnswer answer(options.json);
  const std::vector<simulation::PropertyScan> scans = scans_of(options);
  const tally::RunResult run = results::read_results(options.results);
  const std::vector<simulation::ReweightedPoint> points =
      with_progress("reweighting", [&] { return simulation::reweight_results(options.results, run, scans); });
  if (!run.complete()) std::cout << "partial result: " << run.partial_reason << "\n";
  print(run, scans, points);
  answer.print([&] { return json_of_points(run, scans, points); });
  if (options.output.empty()) return;
  core::write_whole_file(options.output, csv_of(options, run, scans, points), "the table");
  std::cout << "table    " << options.output.string() << "\n";
}

}  // namespace

void add_reweight_command(CLI::App& app) {
  auto options = std::make_shared<ReweightOptions>();
  CLI::App* command = app.add_subcommand(
      "reweight", "A result with other absorption lengths and reflectances, without tracing again");
  command
      ->add_option("RESULT", options->results,
                   "results file (HDF5) of a scene with photon_history = true in [run]")
      ->required();
  command
      ->add_option("--absorption-length", options->lengths,
                   "\"MEDIUM=200 mm\", several \"MEDIUM=100,200 mm,none\", or factors on the traced length "
                   "\"MEDIUM=x0.5,x2\"")
      ->allow_extra_args(false);
  command
      ->add_option("--reflectance", options->reflectances,
                   "\"REFLECTOR=0.95\" (or its surface), \"REFLECTOR=0.9,0.95\", "
                   "\"REFLECTOR=x0.98\"")
      ->allow_extra_args(false);
  command->add_option("-o,--output", options->output, "write a table (CSV)");
  add_json_flag(*command, options->json);
  command->footer("Example: scintray reweight crystal.h5 --absorption-length \"LSO=100,200,400 mm\"");
  command->callback([options] { reweight(*options); });
}

}  // namespace scintray::cli
