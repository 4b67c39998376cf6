#pragma once
/// A photon on its way.

#include <cstdint>

#include "scintray/scene/scene.hpp"

namespace scintray {

struct Photon {
  Vec3 position;  ///< world, mm
  Ray ray;        ///< direction and polarisation
  double wavelength_nm = 0.0;
  double time_ns = 0.0;
  double path_mm = 0.0;
  std::uint32_t region = 0;
  MediumOptics optics;             ///< of the region's medium at this wavelength
  double optical_depth = 0.0;      ///< left until absorption or scattering in the bulk
  std::uint32_t interactions = 0;  ///< boundary interactions so far
  std::uint32_t scatterings = 0;   ///< bulk scatterings so far
};

}  // namespace scintray
