#include <fmt/format.h>

#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/optics/coherent_layers.hpp"

namespace scintray::materials {

namespace {

constexpr double kMostLayers = 200;
constexpr double kThickest_nm = 1e5;

/// A film of the list; `extinction` is the imaginary part of its index.
optics::CoatingLayer read_layer(const config::TomlTable& table) {
  optics::CoatingLayer layer;
  layer.index = table.curve("index", core::Dimension::dimensionless);
  table.expect("index", layer.index.min_y() > 0.0 && layer.index.max_y() <= 10.0,
               "the index of a film lies above 0, up to 10");
  if (table.has("extinction")) {
    layer.extinction = table.curve("extinction", core::Dimension::dimensionless);
    table.expect("extinction", layer.extinction.min_y() >= 0.0 && layer.extinction.max_y() <= 20.0,
                 "the extinction of a film, the imaginary part of its index, lies between 0 and 20");
  }
  constexpr double kNmPerMm = 1e6;
  layer.thickness_nm = table.quantity("thickness", core::Dimension::length) * kNmPerMm;
  table.expect("thickness", layer.thickness_nm > 0.0 && layer.thickness_nm <= kThickest_nm,
               fmt::format("the thickness of a film lies above 0, up to 0.1 mm, but this one is {:g} nm",
                           layer.thickness_nm),
               "light does not interfere in thicker layers: make them a gap with gap_thickness, or a part");
  return layer;
}

}  // namespace

SurfaceModel thin_film_model() {
  const auto read = [](const config::TomlTable& surface) {
    const config::TomlTable table = surface.table("thin_film");
    std::vector<optics::CoatingLayer> layers;
    std::vector<WavelengthTable> curves;
    for (const config::TomlTable& layer : table.tables("layers")) {
      layers.push_back(read_layer(layer));
      curves.push_back({layers.back().index, "refractive indices of a film", layer.where("index")});
      curves.push_back({layers.back().extinction, "extinctions of a film", layer.where("extinction")});
    }
    if (layers.empty() || static_cast<double>(layers.size()) > kMostLayers)
      table.report(
          "layers",
          fmt::format("a thin film has 1 to {:g} layers, but this one has {}", kMostLayers, layers.size()),
          "list them from the inside, as layers = [{ index = 1.38, thickness = \"99.6 nm\" }]");
    optics::ThinFilmSurface::Options options;
    options.frustrated = table.boolean("frustrated_transmission", true);
    options.transmits = table.boolean("transmits", true);
    return FixedMicrosurface(
        optics::ThinFilmSurface(std::move(layers), options, read_roughness(table, "a face with films")),
        std::nullopt, std::move(curves));
  };
  return {.word = "thin_film", .table = "thin_film", .read = read};
}

}  // namespace scintray::materials
