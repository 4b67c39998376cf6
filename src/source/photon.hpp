#pragma once
/// A photon on its way.

#include <cstdint>
#include <vector>

#include "scintray/medium/wavelength_shifter.hpp"
#include "scintray/scene/scene.hpp"

namespace scintray {

/// What the wavelength shifter of one medium or one surface did to a photon.
struct PhotonShifts {
  bool at_surface = false;
  std::uint32_t where = 0;  ///< index into Scene::surfaces or Scene::media
  ShiftCount count;
};

struct Photon {
  Vec3 position;  ///< world, mm
  Ray ray;        ///< direction and polarisation
  double wavelength_nm = 0.0;
  double time_ns = 0.0;
  double path_mm = 0.0;
  std::uint32_t region = 0;
  MediumOptics optics;                   ///< of the region's medium at this wavelength
  double optical_depth = 0.0;            ///< left until absorption or scattering in the bulk
  std::uint32_t interactions = 0;        ///< boundary interactions so far
  std::uint32_t scatterings = 0;         ///< bulk scatterings so far
  std::vector<PhotonShifts> shifts;      ///< so far, one entry for each medium or surface that shifted
  ReflectionLog* reflections = nullptr;  ///< told of each survived reflection; null: nobody asks

  /// The entry of a medium or surface, made when there is none.
  ShiftCount& shifts_of(bool at_surface, std::uint32_t where) {
    for (PhotonShifts& known : shifts)
      if (known.at_surface == at_surface && known.where == where) return known.count;
    return shifts.emplace_back(PhotonShifts{at_surface, where, {}}).count;
  }
};

}  // namespace scintray
