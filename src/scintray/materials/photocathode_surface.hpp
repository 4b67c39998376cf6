#pragma once
/// The surface that a photocathode is.

#include "scintray/detector/sensor.hpp"
#include "scintray/materials/surface_spec.hpp"

namespace scintray::materials {

/// The film of a sensor's photocathode as a surface, between the media on its two sides. The caller
/// checks that n and k cover the wavelengths in use.
SurfaceSpec photocathode_surface(const detector::Sensor& sensor);

}  // namespace scintray::materials
