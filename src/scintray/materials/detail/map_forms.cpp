#include "scintray/materials/detail/map_forms.hpp"

#include <algorithm>
#include <array>

#include "scintray/materials/power_spectrum.hpp"

namespace scintray::materials {

namespace {

std::uint32_t read_points(const config::TomlTable& table, const std::string& key, std::uint32_t fallback) {
  const std::int64_t value = table.integer(key, static_cast<std::int64_t>(fallback));
  table.expect(key, value >= 2 && value <= 16384, "\"" + key + "\" lies between 2 and 16384");
  return value >= 2 && value <= 16384 ? static_cast<std::uint32_t>(value) : fallback;
}

topography::Leveling read_leveling(const config::TomlTable& table) {
  using Kind = topography::Leveling::Kind;
  const std::string word = table.choice("level", {"none", "mean", "plane", "polynomial"});
  topography::Leveling leveling;
  leveling.kind = word == "none"    ? Kind::none
                  : word == "mean"  ? Kind::mean
                  : word == "plane" ? Kind::plane
                                    : Kind::polynomial;
  table.has("degree");
  if (leveling.kind == Kind::polynomial) {
    leveling.degree = static_cast<int>(table.integer("degree"));
    table.expect("degree", leveling.degree >= 1 && leveling.degree <= 8,
                 "the degree of the levelling polynomial lies between 1 and 8");
  }
  return leveling;
}

/// x, y, width, height.
std::optional<topography::CropLengths> read_crop(const config::TomlTable& table) {
  if (!table.has("crop")) return std::nullopt;
  const std::vector<double> mm = table.quantities("crop", core::Dimension::length, 4);
  if (mm.size() != 4) return std::nullopt;
  table.expect("crop", std::min(mm[0], mm[1]) >= 0.0 && std::min(mm[2], mm[3]) > 0.0,
               "\"crop\" is x, y, width and height, none of them negative");
  return topography::CropLengths{mm[0] * 1e3, mm[1] * 1e3, mm[2] * 1e3, mm[3] * 1e3};
}

int read_radius(const config::TomlTable& table, const std::string& key, int fallback) {
  const std::int64_t radius = table.integer(key, fallback);
  table.expect(key, radius >= 1 && radius <= 50, "\"" + key + "\" lies between 1 and 50 pixels");
  return static_cast<int>(std::clamp<std::int64_t>(radius, 1, 50));
}

/// Reports the keys of `keys` that are absent from a recipe that starts from nothing.
void need(const config::TomlTable& table, const std::string& kind, const std::vector<std::string>& keys) {
  for (const std::string& key : keys)
    if (!table.has(key))
      table.report(key, "a recipe of kind \"" + kind + "\" needs \"" + key + "\"",
                   "give it, or start from kind = \"ground\" or \"polished\"");
}

void read_gaussian(const config::TomlTable& table, const std::string& kind,
                   topography::GaussianRelief& relief) {
  relief.rms_height_um = read_um(table, "rms_height", relief.rms_height_um, true);
  relief.correlation_length_um = read_um(table, "correlation_length", relief.correlation_length_um, false);
  if (kind != "saw_cut") return;
  relief.lay_length_um = read_um(table, "lay_length", relief.correlation_length_um, false);
  relief.lay_angle_rad = table.quantity("lay_angle", core::Dimension::angle);
  table.expect("lay_length", relief.lay_length_um >= relief.correlation_length_um,
               "\"lay_length\" is shorter than \"correlation_length\", but a relief changes faster across "
               "its lay than along it");
}

void read_fracture(const config::TomlTable& table, topography::FractureRelief& fracture) {
  fracture.spacing_um = read_um(table, "spacing", fracture.spacing_um, false);
  fracture.rise_um = read_um(table, "rise", fracture.rise_um, true);
  fracture.exponent = table.number("exponent", fracture.exponent);
  table.expect("exponent", fracture.exponent >= 1.0, "\"exponent\" must be at least 1");
  fracture.depth_spread_um = read_um(table, "depth_spread", fracture.depth_spread_um, true);
  fracture.size_spread = table.number("size_spread", fracture.size_spread);
  table.expect("size_spread", fracture.size_spread >= 0.0 && fracture.size_spread < 1.0,
               "\"size_spread\" lies between 0 and 1, 1 excluded");
}

void read_scratches(const config::TomlTable& recipe, const std::string& kind,
                    topography::ScratchRelief& scratches) {
  const std::optional<config::TomlTable> table = recipe.optional_table("scratches");
  if (!table) return;
  if (kind != "polished") need(*table, kind, {"spacing", "length", "depth", "width"});
  scratches.spacing_um = read_um(*table, "spacing", scratches.spacing_um, true);
  scratches.length_um = read_um(*table, "length", scratches.length_um, false);
  scratches.depth_um = read_um(*table, "depth", scratches.depth_um, true);
  scratches.width_um = read_um(*table, "width", scratches.width_um, false);
}

void read_k_correlation(const config::TomlTable& table, topography::KCorrelationRelief& relief) {
  relief.rms_height_um = read_um(table, "rms_height", relief.rms_height_um, true);
  relief.knee_length_um = read_um(table, "knee_length", relief.knee_length_um, false);
  relief.exponent = table.number("exponent", relief.exponent);
  table.expect("exponent", relief.exponent > 1.0,
               "\"exponent\" of a K-correlation spectrum must be above 1, or its power is infinite");
}

void read_spectrum(const config::TomlTable& table, topography::SpectrumRelief& spectrum) {
  const std::filesystem::path file = table.existing_file("spectrum");
  const std::string frequency = table.string("frequency_unit"), density = table.string("density_unit");
  if (file.empty() || frequency.empty() || density.empty()) return;
  try {
    spectrum = read_power_spectrum(file, frequency, density, table.where("spectrum"));
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      table.report("spectrum",
                   problem.where.file.empty() ? problem.what : problem.where.text() + ": " + problem.what,
                   problem.hint);
  }
}

/// What each kind needs that no default gives.
const std::vector<std::string>& needs_of(const std::string& kind) {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> needs{
      {"gaussian", {"rms_height", "correlation_length"}},
      {"saw_cut", {"rms_height", "correlation_length", "lay_length", "lay_angle"}},
      {"fracture", {"rms_height", "correlation_length", "spacing", "rise"}},
      {"k_correlation", {"rms_height", "knee_length", "exponent"}},
      {"spectrum", {"spectrum", "frequency_unit", "density_unit"}}};
  static const std::vector<std::string> none;
  for (const auto& [name, keys] : needs)
    if (name == kind) return keys;
  return none;
}

}  // namespace

std::optional<double> read_optional_um(const config::TomlTable& table, const std::string& key) {
  const std::optional<double> length_mm = table.optional_quantity(key, core::Dimension::length);
  if (!length_mm) return std::nullopt;
  table.expect(key, *length_mm > 0.0, "\"" + key + "\" must be positive");
  return *length_mm * 1e3;
}

double read_um(const config::TomlTable& table, const std::string& key, double fallback_um,
               bool zero_allowed) {
  const std::optional<double> length_mm = table.optional_quantity(key, core::Dimension::length);
  if (!length_mm) return fallback_um;
  table.expect(key, zero_allowed ? *length_mm >= 0.0 : *length_mm > 0.0,
               "\"" + key + "\" must " + (zero_allowed ? "not be negative" : "be positive"));
  return *length_mm * 1e3;
}

topography::Preparation read_preparation(const config::TomlTable& table) {
  topography::Preparation preparation;
  if (const auto crop = read_crop(table)) preparation.crop = *crop;
  preparation.outlier_limit = table.optional_number("outliers");
  table.expect("outliers", !preparation.outlier_limit || *preparation.outlier_limit >= 1.0,
               "\"outliers\" counts robust standard deviations and is at least 1");
  table.has("outlier_radius");
  if (preparation.outlier_limit) preparation.outlier_radius = read_radius(table, "outlier_radius", 2);
  preparation.fill_missing = table.boolean("fill_missing", false);
  if (table.has("median_radius")) preparation.median_radius = read_radius(table, "median_radius", 1);
  preparation.loess_width_um = read_optional_um(table, "loess_width");
  preparation.gaussian_um = read_optional_um(table, "gaussian_width");
  preparation.leveling = read_leveling(table);
  return preparation;
}

topography::SynthesisRecipe read_synthesis(const config::TomlTable& table) {
  const std::string kind = table.choice(
      "kind", {"ground", "polished", "gaussian", "fracture", "saw_cut", "k_correlation", "spectrum"});
  topography::SynthesisRecipe recipe;
  if (kind == "ground") recipe = topography::ground_recipe();
  if (kind == "polished") recipe = topography::polished_recipe();
  recipe.name = kind;
  for (const char* key : {"rms_height", "correlation_length", "lay_length", "lay_angle", "spacing", "rise",
                          "exponent", "depth_spread", "size_spread", "scratches", "knee_length", "spectrum",
                          "frequency_unit", "density_unit"})
    table.has(key);
  need(table, kind, needs_of(kind));
  if (kind == "spectrum")
    read_spectrum(table, recipe.spectrum);
  else if (kind == "k_correlation")
    read_k_correlation(table, recipe.k_correlation);
  else
    read_gaussian(table, kind, recipe.gaussian);
  if (kind == "ground" || kind == "fracture") read_fracture(table, recipe.fracture);
  if (kind != "ground" && kind != "fracture") read_scratches(table, kind, recipe.scratches);
  recipe.pitch_um = read_um(table, "pitch", recipe.pitch_um, false);
  recipe.columns = read_points(table, "columns", recipe.columns);
  recipe.rows = read_points(table, "rows", recipe.rows);
  const std::int64_t seed = table.integer("seed", static_cast<std::int64_t>(recipe.seed));
  table.expect("seed", seed >= 0, "\"seed\" must be at least 0");
  recipe.seed = static_cast<std::uint64_t>(std::max<std::int64_t>(0, seed));
  return recipe;
}

}  // namespace scintray::materials
