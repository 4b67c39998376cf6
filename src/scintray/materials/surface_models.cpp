#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

// Each is defined in surface_models/NAME.cpp.
SurfaceModel smooth_model();
SurfaceModel painted_model();
SurfaceModel unified_model();
SurfaceModel table_model();
SurfaceModel height_map_model();
SurfaceModel recipe_model();

SurfaceModels::SurfaceModels() {
  for (const auto model :
       {smooth_model, painted_model, unified_model, table_model, height_map_model, recipe_model})
    add(model());
}

}  // namespace scintray::materials
