#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/optics/coherent_layers.hpp"

namespace scintray::materials {

namespace {

constexpr double kGreatestPart = 50.0;

core::Curve read_part(const config::TomlTable& table, const std::string& key) {
  const core::Curve curve = table.curve(key, core::Dimension::dimensionless);
  table.expect(key, curve.min_y() >= 0.0 && curve.max_y() <= kGreatestPart,
               "the parts of a metal's index lie between 0 and 50",
               "write the index as n + i k with k positive");
  return curve;
}

}  // namespace

SurfaceModel metal_model() {
  const auto read = [](const config::TomlTable& surface) {
    const config::TomlTable table = surface.table("metal");
    optics::MetalSurface metal;
    if (table.has("n") || table.has("k"))
      metal.metal = optics::MetalIndex{read_part(table, "n"), read_part(table, "k")};
    metal.facets = read_roughness(table, "a metal");
    std::vector<WavelengthTable> curves;
    if (metal.metal)
      curves = {{metal.metal->n, "real parts of its index", table.where("n")},
                {metal.metal->k, "imaginary parts of its index", table.where("k")}};
    return FixedMicrosurface(metal, std::nullopt, std::move(curves));
  };
  return {.word = "metal", .table = "metal", .read = read};
}

}  // namespace scintray::materials
