#pragma once
/// The numbers of a photon in the plain data of the kernels (LaneWork, LanePhoton), and back.

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "scintray/scene/scene.hpp"
#include "scintray/source/light_source.hpp"

namespace scintray::transport {

static_assert(sizeof(core::PlainVec3) == sizeof(double[3]) && std::is_trivially_copyable_v<core::PlainVec3>);
/// The numbers of a vector. Two at once, as they are loaded: a load of two waits for stores of one.
inline void copy(const core::PlainVec3& from, double (&to)[3]) { std::memcpy(to, &from, sizeof(to)); }
/// The reverse.
inline core::PlainVec3 vec(const double (&from)[3]) {
  core::PlainVec3 to;
  std::memcpy(&to, from, sizeof(to));
  return to;
}

/// Sets what a kernel needs of a photon and its region.
template <typename Numbers>
void give_photon(const scene::Scene& scene, const source::Photon& photon, Numbers& to) {
  copy(photon.position, to.position);
  copy(photon.ray.direction, to.direction);
  copy(photon.ray.polarisation, to.polarisation);
  copy(scene.regions[photon.region].centre, to.centre);
  to.path_mm = photon.path_mm;
  to.time_ns = photon.time_ns;
  to.depth_left = photon.optical_depth;
  to.interactions = photon.interactions;
  to.group_index = photon.optics.group_index;
  to.attenuation_per_mm = photon.optics.absorption_per_mm + photon.optics.scattering_per_mm;
}

/// Sets what a kernel changes of a photon.
template <typename Numbers>
void take_photon(const Numbers& from, source::Photon& photon) {
  photon.position = vec(from.position);
  photon.ray.direction = vec(from.direction);
  photon.ray.polarisation = vec(from.polarisation);
  photon.path_mm = from.path_mm;
  photon.time_ns = from.time_ns;
  photon.optical_depth = from.depth_left;
  photon.interactions = static_cast<std::uint32_t>(from.interactions);
}

}  // namespace scintray::transport
