#include "scintray/detector/microcells.hpp"

#include <algorithm>

#include "scintray/materials/sensor_models.hpp"

namespace scintray::materials {

namespace {

/// Largest accepted probability of crosstalk or of afterpulses: from 1 - exp(-1), 63 %, on every avalanche
/// triggers at least one other on average, without end.
constexpr double kMostSecondaries = 0.6;
constexpr std::int64_t kMostMicrocells = 100'000'000;

/// A probability, at most its limit; 0 when absent.
double read_chance(const config::TomlTable& table, const std::string& key) {
  const double chance = table.quantity(key, core::Dimension::dimensionless, 0.0);
  table.expect(key, chance >= 0.0 && chance <= kMostSecondaries, "this probability lies between 0 and 60 %",
               "give the probability of one avalanche, as \"3 %\"");
  return chance;
}

void read_pitch(const config::TomlTable& table, detector::Microcells& cells) {
  cells.pitch_mm = table.quantity("pitch", core::Dimension::length);
  table.expect("pitch", cells.pitch_mm > 0.0, "\"pitch\" must be above 0");
}

void read_cell_count(const config::TomlTable& table, detector::Microcells& cells) {
  const std::int64_t count = table.integer("count");
  table.expect("count", count >= 1 && count <= kMostMicrocells, "a sensor has 1 to 10^8 cells");
  cells.count = static_cast<std::uint32_t>(std::clamp<std::int64_t>(count, 1, kMostMicrocells));
}

using CellReader = void (*)(const config::TomlTable& table, detector::Microcells& cells);
constexpr core::Word<CellReader> kCellForms[] = {{"pitch", read_pitch}, {"count", read_cell_count}};

detector::Microcells read_microcells(const config::TomlTable& table) {
  detector::Microcells cells;
  if (const auto* form = table.one_of(kCellForms, true)) form->value(table, cells);
  cells.recovery_ns = table.quantity("recovery", core::Dimension::time);
  table.expect("recovery", cells.recovery_ns > 0.0, "\"recovery\" must be above 0");
  cells.crosstalk = read_chance(table, "crosstalk");
  cells.afterpulse = read_chance(table, "afterpulse");
  if (cells.afterpulse > 0.0 || table.has("afterpulse_time")) {
    cells.afterpulse_time_ns = table.quantity("afterpulse_time", core::Dimension::time);
    table.expect("afterpulse_time", cells.afterpulse_time_ns > 0.0, "\"afterpulse_time\" must be above 0");
  }
  return cells;
}

}  // namespace

SensorModel microcells_model() {
  const auto read = [](const config::TomlTable& sensor, SourceRule rule, std::vector<std::string>& sources) {
    const config::TomlTable table = sensor.table("microcells");
    if (sensor.has("microcells")) read_source(table, rule, sources);
    return detector::MicrocellModel(read_microcells(table));
  };
  return {.word = "microcells", .table = "microcells", .read = read};
}

}  // namespace scintray::materials
