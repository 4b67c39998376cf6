#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

// The models that are built in, a line each: NAME is the function NAME_model that surface_models/NAME.cpp
// defines.
#define SCINTRAY_SURFACE_MODELS(ADD) \
  ADD(smooth)                        \
  ADD(painted)                       \
  ADD(unified)                       \
  ADD(glisur)                        \
  ADD(thin_film)                     \
  ADD(metal)                         \
  ADD(slightly_rough)                \
  ADD(wave_scatter)                  \
  ADD(angular)                       \
  ADD(table)                         \
  ADD(geant4_table)                  \
  ADD(measured_brdf)                 \
  ADD(mirror_scatter)                \
  ADD(height_map)                    \
  ADD(recipe)

#define SCINTRAY_DECLARE(name) SurfaceModel name##_model();
SCINTRAY_SURFACE_MODELS(SCINTRAY_DECLARE)
#undef SCINTRAY_DECLARE

SurfaceModels::SurfaceModels() {
#define SCINTRAY_ADD(name) add(name##_model());
  SCINTRAY_SURFACE_MODELS(SCINTRAY_ADD)
#undef SCINTRAY_ADD
}

}  // namespace scintray::materials
