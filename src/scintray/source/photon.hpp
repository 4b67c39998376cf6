#pragma once
/// The state of a photon.

#include <cstdint>
#include <type_traits>

#include "scintray/core/ids.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::source {

/// The state of one photon, as plain data: what only some scenes add lies beside it, in PhotonRecords.
struct Photon {
  core::PlainVec3 position;  ///< world, mm
  optics::Ray ray;           ///< direction and polarisation
  double wavelength_nm = 0.0;
  double time_ns = 0.0;
  double path_mm = 0.0;
  double optical_depth = 0.0;      ///< left until absorption or scattering in the bulk
  optics::MediumOptics optics;     ///< of the region's medium at this wavelength
  core::RegionId region;           ///< in which it is
  std::uint32_t interactions = 0;  ///< boundary interactions so far
  std::uint32_t scatterings = 0;   ///< bulk scatterings so far
};
static_assert(std::is_trivially_copyable_v<Photon>);

}  // namespace scintray::source
