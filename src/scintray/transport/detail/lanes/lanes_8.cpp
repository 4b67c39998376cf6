#include "scintray/transport/detail/lanes/lane_body_walls.hpp"
#include "scintray/transport/detail/lanes/lane_flat_walls.hpp"
#include "scintray/transport/detail/lanes/lane_in_box.hpp"
#include "scintray/transport/detail/lanes/lane_passes.hpp"
#include "scintray/transport/detail/lanes/lane_refraction.hpp"

namespace scintray::transport {

void propagate_lanes_8(const LanePlanes& planes, const LaneLimits& limits, LaneWork* const* photons,
                       std::size_t count) {
  if (planes.box) return propagate_in_box<core::LaneReal<xsimd::avx512f>>(planes, limits, photons, count);
  propagate_between_planes<core::LaneReal<xsimd::avx512f>>(planes, limits, photons, count);
}

void propagate_lanes_in_body_8(const LaneBody& body, const LaneLimits& limits, LaneWork* const* photons,
                               std::size_t count) {
  propagate_in_body<core::LaneReal<xsimd::avx512f>>(body, limits, photons, count);
}

void refract_lanes_8(const LaneNormal* normals, LaneWork* const* photons, std::size_t count) {
  refract_at_faces<core::LaneReal<xsimd::avx512f>>(normals, photons, count);
}

void run_lanes_8(LanePool& pool) { run_passes<core::LaneReal<xsimd::avx512f>>(pool); }

}  // namespace scintray::transport
