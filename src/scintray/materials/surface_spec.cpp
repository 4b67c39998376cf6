#include "scintray/materials/surface_spec.hpp"

namespace scintray::materials {

SurfaceSpec traced_on_the_spot(SurfaceSpec spec) {
  if (auto* map = std::get_if<HeightMapSpec>(&spec.microsurface)) map->table.reset();
  if (auto* recipe = std::get_if<RecipeSpec>(&spec.microsurface)) recipe->table.reset();
  for (ShareSpec& part : spec.mixture)
    part.surface = std::make_shared<const SurfaceSpec>(traced_on_the_spot(*part.surface));
  return spec;
}

}  // namespace scintray::materials
