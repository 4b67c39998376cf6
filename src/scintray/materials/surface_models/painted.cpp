#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

SurfaceModel painted_model() {
  const auto read = [](const config::TomlTable&) {
    return FixedMicrosurface(optics::PaintedSurface(), "painted");
  };
  return {.word = "painted", .table = "", .read = read};
}

}  // namespace scintray::materials
