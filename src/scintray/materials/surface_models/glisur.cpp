#include <fmt/format.h>

#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

SurfaceModel glisur_model() {
  const auto read = [](const config::TomlTable& surface) {
    const config::TomlTable table = surface.table("glisur");
    const double polish = read_share(table, "polish", std::nullopt);
    optics::FacetSurface facets;
    facets.sampling = read_facet_sampling(table);
    facets.smear = 1.0 - polish;
    return FixedMicrosurface(facets,
                             fmt::format("GLISUR polish {}, {}", polish, static_cast<int>(facets.sampling)));
  };
  return {.word = "glisur", .table = "glisur", .read = read};
}

}  // namespace scintray::materials
