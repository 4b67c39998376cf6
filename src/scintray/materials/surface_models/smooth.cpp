#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

SurfaceModel smooth_model() {
  const auto read = [](const config::TomlTable&) {
    return FixedMicrosurface(optics::SmoothSurface(), "smooth");
  };
  return {.word = "smooth", .table = "", .read = read};
}

}  // namespace scintray::materials
