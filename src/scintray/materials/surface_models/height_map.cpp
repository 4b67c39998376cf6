#include <algorithm>

#include "scintray/core/named_file.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/table_key.hpp"

namespace scintray::materials {

namespace {

constexpr core::Word<topography::Leveling::Kind> kLevels[] = {
    {"none", topography::Leveling::Kind::none},
    {"mean", topography::Leveling::Kind::mean},
    {"plane", topography::Leveling::Kind::plane},
    {"polynomial", topography::Leveling::Kind::polynomial}};
constexpr core::Word<topography::Tiling> kTilings[] = {{"automatic", topography::Tiling::automatic},
                                                       {"mirror", topography::Tiling::mirror},
                                                       {"periodic", topography::Tiling::periodic}};

topography::Leveling read_leveling(const config::TomlTable& table) {
  topography::Leveling leveling;
  leveling.kind = table.choice("level", kLevels);
  table.has("degree");
  if (leveling.kind == topography::Leveling::Kind::polynomial) {
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

/// Cropping, outliers, filling, filters and levelling.
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

HeightMapSpec read_height_map_spec(const config::TomlTable& surface) {
  const config::TomlTable table = surface.table("height_map");
  HeightMapSpec spec;
  spec.where = table.where();
  spec.path = table.existing_file("file");
  spec.options.channel = table.optional_string("channel");
  spec.options.pitch_um = read_optional_um(table, "pitch");
  spec.options.width_um = read_optional_um(table, "width");
  spec.options.height_unit_um = read_optional_um(table, "height_unit");
  spec.options.periodic = table.boolean("periodic", false);
  table.expect("width", !spec.options.pitch_um || !spec.options.width_um,
               "\"pitch\" and \"width\" are both given, but each follows from the other", "keep one of them");
  if (surface.has("height_map")) spec.preparation = read_preparation(table);
  spec.tiling = table.choice("tiling", kTilings, topography::Tiling::automatic);
  spec.table = read_tracing(surface);
  return spec;
}

}  // namespace

std::string HeightMapSpec::relief_key() const { return height_map_key({path, options, preparation, tiling}); }

Relief HeightMapSpec::make_relief() const {
  topography::HeightMap map =
      core::read_named_file(where, [&] { return topography::read_height_map(path, options); });
  topography::prepare(map, preparation);
  Relief result;
  result.provenance.map = path.filename().string();
  result.provenance.preparation = map.history();
  result.provenance.tiling = topography::tiling_name(map, tiling);
  result.field = std::make_shared<const optics::HeightField>(topography::make_height_field(map, tiling));
  return result;
}

std::optional<MicrosurfaceSpec> HeightMapSpec::traced_on_the_spot() const {
  if (!table) return std::nullopt;
  HeightMapSpec traced = *this;
  traced.table.reset();
  return traced;
}

SurfaceModel height_map_model() {
  return {.word = "height_map", .table = "height_map", .read = read_height_map_spec};
}

}  // namespace scintray::materials
