#include "scintray/materials/detail/sensor_form.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scintray/core/statistics.hpp"

namespace scintray::materials {

namespace {

constexpr double kHighestIndex = 5.0;
/// More than this, and every avalanche fires another one for ever (1 - exp(-1) is 63 %).
constexpr double kMostSecondaries = 0.6;
constexpr double kMostSpread = 3.0;
constexpr std::int64_t kMostMicrocells = 100'000'000;

/// A probability up to a limit; 0 when absent.
double read_chance(const config::TomlTable& table, const std::string& key) {
  const double chance = table.quantity(key, core::Dimension::dimensionless, 0.0);
  table.expect(key, chance >= 0.0 && chance <= kMostSecondaries, "this probability lies between 0 and 60 %",
               "give the probability of one avalanche, as \"3 %\"");
  return chance;
}

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
  const bool outside = table.choice("measured_in", {"window", "outside"}) == "outside";
  const bool external = table.choice("definition", {"internal", "external"}) == "external";
  angle.measured_in = outside ? detector::AngleMedium::outside : detector::AngleMedium::window;
  angle.definition =
      external ? detector::EfficiencyDefinition::external : detector::EfficiencyDefinition::internal;
  if (outside || external || table.has("reference_index")) {
    angle.reference_index = table.number("reference_index");
    table.expect("reference_index", angle.reference_index >= 1.0 && angle.reference_index <= kHighestIndex,
                 "a refractive index lies between 1 and 5", "write 1.0 for a measurement in air");
  }
  sensor.angle = std::move(angle);
  if (table.good("measured_in") && table.good("definition")) check_angle(table, sensor);
}

double read_time_spread(const config::TomlTable& table) {
  const std::optional<std::string> form = table.one_of({"fwhm", "sigma"}, true);
  if (!form) return 0.0;
  const double width_ns = table.quantity(*form, core::Dimension::time);
  expect_positive(table, *form, width_ns);
  return form == "fwhm" ? width_ns / core::kFwhmPerSigma : width_ns;
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

detector::Microcells read_microcells(const config::TomlTable& table) {
  detector::Microcells cells;
  const std::optional<std::string> form = table.one_of({"pitch", "count"}, true);
  if (form == "pitch") {
    cells.pitch_mm = table.quantity("pitch", core::Dimension::length);
    expect_positive(table, "pitch", cells.pitch_mm);
  } else if (form == "count") {
    const std::int64_t count = table.integer("count");
    table.expect("count", count >= 1 && count <= kMostMicrocells, "a sensor has 1 to 10^8 cells");
    cells.count = static_cast<std::uint32_t>(std::clamp<std::int64_t>(count, 1, kMostMicrocells));
  }
  cells.recovery_ns = table.quantity("recovery", core::Dimension::time);
  expect_positive(table, "recovery", cells.recovery_ns);
  cells.crosstalk = read_chance(table, "crosstalk");
  cells.afterpulse = read_chance(table, "afterpulse");
  if (cells.afterpulse > 0.0 || table.has("afterpulse_time")) {
    cells.afterpulse_time_ns = table.quantity("afterpulse_time", core::Dimension::time);
    expect_positive(table, "afterpulse_time", cells.afterpulse_time_ns);
  }
  return cells;
}

/// Higher rates than this are mistakes of unit: an avalanche a ns.
constexpr double kMostDarkCounts_per_ns = 1.0;

detector::DarkCounts read_dark_counts(const config::TomlTable& table) {
  detector::DarkCounts dark;
  const std::optional<std::string> form = table.one_of({"rate", "rate_per_mm2"}, true);
  if (!form) return dark;
  const double rate = table.quantity(*form, core::Dimension::frequency);
  table.expect(*form, rate >= 0.0 && rate <= kMostDarkCounts_per_ns,
               "a dark count rate lies between 0 and 1 GHz", "give counts a second, as \"2 MHz\"");
  (form == "rate" ? dark.per_ns : dark.per_ns_mm2) = rate;
  return dark;
}

}  // namespace

void read_sensor_response(const config::TomlTable& table, SourceRule rule, detector::Sensor& sensor) {
  if (const auto angle = table.optional_table("angle")) read_angle(*angle, rule, sensor);
  const auto block = [&](const std::string& key) {
    std::optional<config::TomlTable> found = table.optional_table(key);
    if (found) read_source(*found, rule, sensor.sources);
    return found;
  };
  if (const auto time = block("transit_time")) sensor.time_spread_ns = read_time_spread(*time);
  if (const auto electron = block("single_electron"))
    sensor.single_electron = read_single_electron(*electron);
  if (const auto cells = block("microcells")) sensor.microcells = read_microcells(*cells);
  if (const auto dark = block("dark_counts")) sensor.dark_counts = read_dark_counts(*dark);
}

}  // namespace scintray::materials
