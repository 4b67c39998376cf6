#include <algorithm>

#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/power_spectrum.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/table_key.hpp"

namespace scintray::materials {

namespace {

enum class RecipeKind { ground, polished, gaussian, fracture, saw_cut, k_correlation, spectrum };

constexpr core::Word<RecipeKind> kRecipeKinds[] = {
    {"ground", RecipeKind::ground},     {"polished", RecipeKind::polished},
    {"gaussian", RecipeKind::gaussian}, {"fracture", RecipeKind::fracture},
    {"saw_cut", RecipeKind::saw_cut},   {"k_correlation", RecipeKind::k_correlation},
    {"spectrum", RecipeKind::spectrum}};

std::uint32_t read_points(const config::TomlTable& table, const std::string& key, std::uint32_t fallback) {
  const std::int64_t value = table.integer(key, static_cast<std::int64_t>(fallback));
  table.expect(key, value >= 2 && value <= 16384, "\"" + key + "\" lies between 2 and 16384");
  return value >= 2 && value <= 16384 ? static_cast<std::uint32_t>(value) : fallback;
}

/// Reports those of `keys` that are absent from a recipe without a base.
void need(const config::TomlTable& table, RecipeKind kind, const std::vector<std::string>& keys) {
  for (const std::string& key : keys)
    if (!table.has(key))
      table.report(
          key,
          std::string("a recipe of kind \"") + core::word_of(kRecipeKinds, kind) + "\" needs \"" + key + "\"",
          "give it, or start from kind = \"ground\" or \"polished\"");
}

void read_gaussian(const config::TomlTable& table, RecipeKind kind, topography::GaussianRelief& relief) {
  relief.rms_height_um = read_um(table, "rms_height", relief.rms_height_um, true);
  relief.correlation_length_um = read_um(table, "correlation_length", relief.correlation_length_um, false);
  if (kind != RecipeKind::saw_cut) return;
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

void read_scratches(const config::TomlTable& recipe, RecipeKind kind, topography::ScratchRelief& scratches) {
  const std::optional<config::TomlTable> table = recipe.optional_table("scratches");
  if (!table) return;
  if (kind != RecipeKind::polished) need(*table, kind, {"spacing", "length", "depth", "width"});
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
    report_of_file(table, "spectrum", error);
  }
}

/// Keys of each kind that are required, since they have no default.
const std::vector<std::string>& needs_of(RecipeKind kind) {
  static const std::vector<std::pair<RecipeKind, std::vector<std::string>>> needs{
      {RecipeKind::gaussian, {"rms_height", "correlation_length"}},
      {RecipeKind::saw_cut, {"rms_height", "correlation_length", "lay_length", "lay_angle"}},
      {RecipeKind::fracture, {"rms_height", "correlation_length", "spacing", "rise"}},
      {RecipeKind::k_correlation, {"rms_height", "knee_length", "exponent"}},
      {RecipeKind::spectrum, {"spectrum", "frequency_unit", "density_unit"}}};
  static const std::vector<std::string> none;
  for (const auto& [name, keys] : needs)
    if (name == kind) return keys;
  return none;
}

/// The relief of a recipe, with its grid and seed.
topography::SynthesisRecipe read_synthesis(const config::TomlTable& table) {
  const RecipeKind kind = table.choice("kind", kRecipeKinds);
  topography::SynthesisRecipe recipe;
  if (kind == RecipeKind::ground) recipe = topography::ground_recipe();
  if (kind == RecipeKind::polished) recipe = topography::polished_recipe();
  recipe.name = core::word_of(kRecipeKinds, kind);
  for (const char* key : {"rms_height", "correlation_length", "lay_length", "lay_angle", "spacing", "rise",
                          "exponent", "depth_spread", "size_spread", "scratches", "knee_length", "spectrum",
                          "frequency_unit", "density_unit"})
    table.has(key);
  need(table, kind, needs_of(kind));
  if (kind == RecipeKind::spectrum)
    read_spectrum(table, recipe.spectrum);
  else if (kind == RecipeKind::k_correlation)
    read_k_correlation(table, recipe.k_correlation);
  else
    read_gaussian(table, kind, recipe.gaussian);
  const bool cracked = kind == RecipeKind::ground || kind == RecipeKind::fracture;
  if (cracked) read_fracture(table, recipe.fracture);
  if (!cracked) read_scratches(table, kind, recipe.scratches);
  recipe.pitch_um = read_um(table, "pitch", recipe.pitch_um, false);
  recipe.columns = read_points(table, "columns", recipe.columns);
  recipe.rows = read_points(table, "rows", recipe.rows);
  const std::int64_t seed = table.integer("seed", static_cast<std::int64_t>(recipe.seed));
  table.expect("seed", seed >= 0, "\"seed\" must be at least 0");
  recipe.seed = static_cast<std::uint64_t>(std::max<std::int64_t>(0, seed));
  return recipe;
}

RecipeSpec read_recipe(const config::TomlTable& surface) {
  const config::TomlTable table = surface.table("recipe");
  RecipeSpec spec;
  spec.where = table.where();
  if (!surface.has("recipe")) return spec;
  spec.recipe = read_synthesis(table);
  spec.table = read_tracing(surface);
  return spec;
}

}  // namespace

std::string RecipeSpec::relief_key() const { return recipe_key(recipe); }

Relief RecipeSpec::make_relief() const {
  Relief result;
  result.provenance.map = describe(recipe);
  result.provenance.preparation = "none";
  result.provenance.tiling = "periodic";
  result.field = std::make_shared<const optics::HeightField>(
      topography::make_height_field(topography::synthesize(recipe)));
  return result;
}

std::optional<MicrosurfaceSpec> RecipeSpec::traced_on_the_spot() const {
  if (!table) return std::nullopt;
  RecipeSpec traced = *this;
  traced.table.reset();
  return traced;
}

SurfaceModel recipe_model() { return {.word = "recipe", .table = "recipe", .read = read_recipe}; }

}  // namespace scintray::materials
