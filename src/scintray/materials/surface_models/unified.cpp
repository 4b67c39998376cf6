#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

/// The UNIFIED model (optics/facets.hpp).
SurfaceModel unified_model() {
  const auto read = [](const config::TomlTable& surface) {
    const optics::FacetSurface facets = read_facets(surface.table("unified"));
    return FixedMicrosurface(facets, "UNIFIED " + text_of(facets));
  };
  return {.word = "unified", .table = "unified", .read = read};
}

}  // namespace scintray::materials
