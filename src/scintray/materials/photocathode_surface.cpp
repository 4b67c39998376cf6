#include "scintray/materials/photocathode_surface.hpp"

namespace scintray::materials {

SurfaceSpec photocathode_surface(const detector::Sensor& sensor) {
  SurfaceSpec spec;
  spec.name = "photocathode of " + sensor.name;
  spec.sources = sensor.sources;
  spec.microsurface = FixedMicrosurface(optics::ThinFilmSurface({sensor.cathode->film}));
  return spec;
}

}  // namespace scintray::materials
