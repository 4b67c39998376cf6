#include "scintray/materials/detail/surface_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "scintray/core/share_hint.hpp"

namespace scintray::materials {

namespace {

constexpr core::Word<bool> kOnTheSpot[] = {{"table", false}, {"on_the_spot", true}};

double read_positive(const config::TomlTable& table, const std::string& key, core::Dimension dimension,
                     double fallback) {
  const double value = table.quantity(key, dimension, fallback);
  table.expect(key, value > 0.0, "\"" + key + "\" must be positive");
  return value;
}

std::uint64_t read_count(const config::TomlTable& table, const std::string& key, std::uint64_t fallback,
                         std::int64_t least) {
  const std::int64_t value = table.integer(key, static_cast<std::int64_t>(fallback));
  table.expect(key, value >= least, "\"" + key + "\" must be at least " + std::to_string(least));
  return value < least ? fallback : static_cast<std::uint64_t>(value);
}

}  // namespace

std::optional<double> read_optional_um(const config::TomlTable& table, const std::string& key) {
  const std::optional<double> length_mm = table.optional_quantity(key, core::Dimension::length);
  if (!length_mm) return std::nullopt;
  table.expect(key, *length_mm > 0.0, "\"" + key + "\" must be positive");
  return *length_mm * 1e3;
}

void report_of_file(const config::TomlTable& table, const std::string& key, const core::InputError& error) {
  for (const core::Problem& problem : error.problems())
    table.report(key, problem.where.file.empty() ? problem.what : problem.where.text() + ": " + problem.what,
                 problem.hint);
}

double read_um(const config::TomlTable& table, const std::string& key, double fallback_um,
               bool zero_allowed) {
  const std::optional<double> length_mm = table.optional_quantity(key, core::Dimension::length);
  if (!length_mm) return fallback_um;
  table.expect(key, zero_allowed ? *length_mm >= 0.0 : *length_mm > 0.0,
               "\"" + key + "\" must " + (zero_allowed ? "not be negative" : "be positive"));
  return *length_mm * 1e3;
}

double read_share(const config::TomlTable& table, const std::string& key, std::optional<double> fallback) {
  const double share = fallback ? table.quantity(key, core::Dimension::dimensionless, *fallback)
                                : table.quantity(key, core::Dimension::dimensionless);
  table.expect(key, share >= 0.0 && share <= 1.0,
               fmt::format("\"{}\" is {:g}, but a share between 0 and 1 is expected", key, share),
               core::share_hint(share));
  return share;
}

double read_gap_index(const config::TomlTable& table) {
  const double index = table.quantity("gap", core::Dimension::dimensionless, 0.0);
  table.expect("gap", index >= 1.0 && index <= 5.0, "the index of a gap lies between 1 and 5",
               "give the index, as gap = 1.0, or remove it: the reflector is then in contact with the face");
  return index;
}

std::optional<TracingSpec> read_tracing(const config::TomlTable& surface) {
  TracingSpec tracing;
  topography::TableSettings& settings = tracing.settings;
  const std::optional<config::TomlTable> table = surface.optional_table("tracing");
  if (!table) return tracing;
  if (table->choice("mode", kOnTheSpot, false)) {
    for (const char* key : {"incidence_step", "azimuth_step", "rays", "seed", "refine", "wavelengths",
                            "directional", "target_error", "reciprocal"})
      table->has(key);
    return std::nullopt;
  }
  settings.incidence_step_rad =
      read_positive(*table, "incidence_step", core::Dimension::angle, settings.incidence_step_rad);
  settings.azimuth_step_rad =
      read_positive(*table, "azimuth_step", core::Dimension::angle, settings.azimuth_step_rad);
  settings.rays = read_count(*table, "rays", settings.rays, 1);
  settings.seed = read_count(*table, "seed", settings.seed, 0);
  settings.refine = table->boolean("refine", settings.refine);
  settings.directional = table->boolean("directional", settings.directional);
  settings.reciprocal = table->boolean("reciprocal", settings.reciprocal);
  table->expect("reciprocal", !(settings.reciprocal && settings.directional),
                "a table with direction cannot be made reciprocal", "keep one of the two keys");
  settings.target_error = table->number("target_error", settings.target_error);
  table->expect("target_error", settings.target_error >= 0.0 && settings.target_error < 1.0,
                "\"target_error\" is an error of the reflectance, between 0 (none) and 1");
  tracing.wavelengths_nm = table->quantities("wavelengths", core::Dimension::wavelength, 0, false);
  table->expect("wavelengths",
                std::adjacent_find(tracing.wavelengths_nm.begin(), tracing.wavelengths_nm.end(),
                                   std::greater_equal<>()) == tracing.wavelengths_nm.end(),
                "the wavelengths of a table rise, without repeats");
  return tracing;
}

}  // namespace scintray::materials
