#include "scintray/materials/surface_spec.hpp"

namespace scintray::materials {

SurfaceSpec traced_on_the_spot(SurfaceSpec spec) {
  if (const auto traced = spec.microsurface->traced_on_the_spot()) spec.microsurface = *traced;
  for (ShareSpec& part : spec.mixture)
    part.surface = std::make_shared<const SurfaceSpec>(traced_on_the_spot(*part.surface));
  return spec;
}

}  // namespace scintray::materials
