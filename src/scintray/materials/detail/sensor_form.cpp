#include "scintray/materials/detail/forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scintray/core/statistics.hpp"
#include "scintray/materials/detail/sensor_parts.hpp"
#include "scintray/materials/material_forms.hpp"

namespace scintray::materials {

namespace {

constexpr core::Word<detector::AngleMedium> kAngleMedia[] = {{"window", detector::AngleMedium::window},
                                                             {"outside", detector::AngleMedium::outside}};
constexpr core::Word<detector::EfficiencyDefinition> kAngleDefinitions[] = {
    {"internal", detector::EfficiencyDefinition::internal},
    {"external", detector::EfficiencyDefinition::external}};
constexpr core::Word<detector::ConvertedLight> kConvertedLight[] = {
    {"entering", detector::ConvertedLight::entering},
    {"absorbed", detector::ConvertedLight::absorbed},
    {"both", detector::ConvertedLight::both}};
/// Width measures of a normal distribution relative to its standard deviation.
constexpr core::Word<double> kWidthsPerSigma[] = {{"fwhm", core::kFwhmPerSigma}, {"sigma", 1.0}};
constexpr core::Word<double detector::DarkCounts::*> kDarkRates[] = {
    {"rate", &detector::DarkCounts::per_ns}, {"rate_per_mm2", &detector::DarkCounts::per_ns_mm2}};

constexpr double kMostSpread = 3.0;

void expect_positive(const config::TomlTable& table, const std::string& key, double value) {
  table.expect(key, value > 0.0, "\"" + key + "\" must be above 0");
}

void check_angle(const config::TomlTable& table, const detector::Sensor& sensor) {
  const detector::AngularEfficiency& angle = *sensor.angle;
  const core::Curve& factor = angle.factor;
  table.expect("factor", !factor.is_constant(), "a dependence on angle needs angles, but this is one value",
               "write { angle = [0, 30, 60], angle_unit = \"deg\", value = [1, 0.98, 0.9] }");
  table.expect("factor", factor.min_y() >= 0.0, "a factor of efficiency cannot be negative");
  table.expect("factor", factor.x().front() == 0.0 && factor.y().front() == 1.0,
               "the factor is relative to normal incidence, so it must begin at 0 deg with 1",
               "divide by the value at 0 deg");
  table.expect("factor", factor.x().back() < 0.5 * std::numbers::pi,
               "angles of incidence end below 90 deg, where no light enters");
  const bool has_index = !table.has("reference_index") || table.good("reference_index");
  if (!table.good("factor") || !has_index) return;
  const double index =
      angle.measured_in == detector::AngleMedium::outside ? angle.reference_index : sensor.window_index;
  const double greatest = index * std::sin(factor.x().back());
  table.expect(
      "factor",
      greatest < sensor.window_index &&
          (angle.definition == detector::EfficiencyDefinition::internal || greatest < angle.reference_index),
      "at the largest angle of this table light cannot come into the window",
      "check \"measured_in\" and the two indices, or end the table earlier");
  if (!table.good("factor")) return;
  double most = 0.0;
  for (const double angle_rad : factor.x())
    most = std::max(most, sensor.angle_factor(index * std::sin(angle_rad)));
  double highest = 0.0;
  for (const double nm : sensor.efficiency.x())
    highest = std::max(highest, sensor.conversion_probability(nm));
  table.expect("factor", most * highest <= 1.0 + 1e-9,
               "with this factor more photons are converted than enter (" + std::to_string(most * highest) +
                   " of them at most)",
               "check the efficiency, and whether the factor is internal or external");
}

void read_angle(const config::TomlTable& table, SourceRule rule, detector::Sensor& sensor) {
  read_source(table, rule, sensor.sources);
  detector::AngularEfficiency angle;
  angle.factor = table.curve("factor", core::Dimension::dimensionless, core::Dimension::angle);
  angle.measured_in = table.choice("measured_in", kAngleMedia);
  angle.definition = table.choice("definition", kAngleDefinitions);
  if (angle.measured_in == detector::AngleMedium::outside ||
      angle.definition == detector::EfficiencyDefinition::external || table.has("reference_index")) {
    angle.reference_index = table.number("reference_index");
    table.expect("reference_index", angle.reference_index >= 1.0 && angle.reference_index <= kGreatestIndex,
                 "a refractive index lies between 1 and 5", "write 1.0 for a measurement in air");
  }
  sensor.angle = std::move(angle);
  if (table.good("measured_in") && table.good("definition")) check_angle(table, sensor);
}

double read_time_spread(const config::TomlTable& table) {
  const core::Word<double>* form = table.one_of(kWidthsPerSigma, true);
  if (!form) return 0.0;
  const double width_ns = table.quantity(form->word, core::Dimension::time);
  expect_positive(table, form->word, width_ns);
  return width_ns / form->value;
}

detector::SingleElectron read_single_electron(const config::TomlTable& table) {
  detector::SingleElectron electron;
  electron.charge_spread = table.quantity("charge_spread", core::Dimension::dimensionless, 0.0);
  table.expect("charge_spread", electron.charge_spread >= 0.0 && electron.charge_spread <= kMostSpread,
               "the spread of the charge lies between 0 and 3",
               "give the standard deviation over the mean, as 0.4 or \"40 %\"");
  electron.rise_ns = table.quantity("rise", core::Dimension::time, 0.0);
  electron.decay_ns = table.quantity("decay", core::Dimension::time, 0.0);
  table.expect("rise", electron.rise_ns >= 0.0, "a rise time constant cannot be negative");
  table.expect("decay", electron.decay_ns >= 0.0, "a decay time constant cannot be negative");
  return electron;
}

/// Largest accepted dark count rate, one avalanche per ns: higher rates are errors of unit.
constexpr double kMostDarkCounts_per_ns = 1.0;

detector::DarkCounts read_dark_counts(const config::TomlTable& table) {
  detector::DarkCounts dark;
  const core::Word<double detector::DarkCounts::*>* form = table.one_of(kDarkRates, true);
  if (!form) return dark;
  const double rate = table.quantity(form->word, core::Dimension::frequency);
  table.expect(form->word, rate >= 0.0 && rate <= kMostDarkCounts_per_ns,
               "a dark count rate lies between 0 and 1 GHz", "give counts a second, as \"2 MHz\"");
  dark.*(form->value) = rate;
  return dark;
}

/// The model of `model`; without that key the one whose own table is present, or else the first. Nullptr for
/// an unknown word.
const SensorModel* read_model(const config::TomlTable& table, const SensorModels& models) {
  for (const SensorModel& model : models.all())
    if (!model.table.empty()) table.has(model.table);
  if (!table.has("model")) {
    const std::string word = models.stated_by(*table.node());
    return word.empty() ? &models.all().front() : models.find(word);
  }
  const std::string word = table.choice("model", models.words());
  return table.good("model") ? models.find(word) : nullptr;
}

/// Reads the index of the window, or that it is matched to what the sensor touches.
void read_window(const config::TomlTable& window, SourceRule rule, detector::Sensor& sensor) {
  constexpr const char* kMatched = "matched";
  read_source(window, rule, sensor.sources);
  const config::TomlNode* index = window.node()->find("index");
  if (index && index->kind == config::TomlNode::Kind::string) {
    sensor.window_matched = window.string("index") == kMatched;
    window.expect("index", sensor.window_matched,
                  "\"" + window.string("index") + "\" is neither a refractive index nor \"matched\"",
                  "write index = 1.5, or index = \"matched\" for a window of the index of what it touches");
    return;
  }
  sensor.window_index = window.number("index");
  window.expect("index", sensor.window_index >= 1.0 && sensor.window_index <= kGreatestIndex,
                "a refractive index lies between 1 and 5");
}

/// Reports numbers that hold for a window of a known index, where the window is matched.
void check_matched(const config::TomlTable& efficiency, const detector::Sensor& sensor,
                   const std::optional<config::TomlTable>& angle) {
  if (!sensor.window_matched) return;
  const std::string hint = "give [window] the index of the sensor, as index = 1.5";
  efficiency.expect(
      "definition", sensor.definition == detector::EfficiencyDefinition::internal,
      "an external efficiency includes the reflection at the window, and a matched window has none",
      "write definition = \"internal\", or " + hint);
  if (angle)
    angle->report("factor",
                  "a dependence on angle needs the index of the window, and a matched window has none", hint);
}

/// Reads the conversion of an arriving photon, apart from avalanches.
/// @param window  that has been read; empty: absent
void read_efficiency(const config::TomlTable& efficiency, const std::optional<config::TomlTable>& window,
                     SourceRule rule, detector::Sensor& sensor) {
  read_source(efficiency, rule, sensor.sources);
  sensor.efficiency = efficiency.curve("value", core::Dimension::dimensionless);
  expect_share(efficiency, "value", sensor.efficiency, "an efficiency");
  sensor.definition = efficiency.choice("definition", kEfficiencyDefinitions);
  if (sensor.definition == detector::EfficiencyDefinition::external) {
    sensor.reference_index = efficiency.number("reference_index");
    efficiency.expect("reference_index",
                      sensor.reference_index >= 1.0 && sensor.reference_index <= kGreatestIndex,
                      "a refractive index lies between 1 and 5", "write 1.0 for a measurement in air");
    if (!efficiency.good("reference_index") || !window || !window->good("index") || sensor.window_matched)
      return;
    const double r =
        (sensor.window_index - sensor.reference_index) / (sensor.window_index + sensor.reference_index);
    efficiency.expect("value", sensor.efficiency.max_y() <= 1.0 - r * r,
                      "this external efficiency is above what the window lets in (" +
                          std::to_string(1.0 - r * r) + " at normal incidence)",
                      "check the efficiency and the two indices, or write definition = \"internal\"");
  }
}

/// Reports an efficiency that needs what the definition does not have.
void check_cathode(const config::TomlTable& table, const config::TomlTable& efficiency, bool has_window,
                   const detector::Sensor& sensor) {
  const bool of_film = sensor.definition == detector::EfficiencyDefinition::absorbed;
  if (of_film && !sensor.cathode)
    efficiency.report("definition", "an efficiency of absorbed light needs the film that absorbs it",
                      "add [photocathode] with n, k and thickness, or write definition = \"internal\"");
  if (!of_film && sensor.cathode && !has_window && efficiency.good("definition"))
    table.report("photocathode",
                 "an efficiency of light in the window, or before it, needs the index of the window",
                 "add [window] index = 1.47, or write definition = \"absorbed\"");
}

}  // namespace

detector::Sensor read_sensor(const config::TomlTable& table, const std::string& name, SourceRule rule,
                             const SensorModels& models) {
  detector::Sensor sensor;
  sensor.name = name;
  sensor.converts = table.choice("converts", kConvertedLight, detector::ConvertedLight::entering);
  const bool has_cathode = table.has("photocathode");
  std::optional<config::TomlTable> window = table.optional_table("window");
  if (!window && !has_cathode) table.table("window");  // reported
  if (window) read_window(*window, rule, sensor);
  const config::TomlTable efficiency = table.table("efficiency");
  if (table.has("efficiency")) read_efficiency(efficiency, window, rule, sensor);
  const std::optional<config::TomlTable> angle = table.optional_table("angle");
  if (angle) read_angle(*angle, rule, sensor);
  if (has_cathode && table.has("efficiency")) read_photocathode(table, efficiency, rule, sensor);
  check_cathode(table, efficiency, window.has_value(), sensor);
  check_matched(efficiency, sensor, angle);
  const auto block = [&](const std::string& key) {
    std::optional<config::TomlTable> found = table.optional_table(key);
    if (found) read_source(*found, rule, sensor.sources);
    return found;
  };
  if (const auto uniformity = block("uniformity")) read_face_response(*uniformity, sensor);
  if (const auto time = block("transit_time")) sensor.time_spread_ns = read_time_spread(*time);
  if (const auto electron = block("single_electron"))
    sensor.single_electron = read_single_electron(*electron);
  if (const SensorModel* model = read_model(table, models))
    sensor.avalanches = model->read(table, rule, sensor.sources);
  if (const auto dark = block("dark_counts")) sensor.dark_counts = read_dark_counts(*dark);
  return sensor;
}

}  // namespace scintray::materials
