#include "scintray/transport/detail/lanes/lane_body_walls.hpp"
#include "scintray/transport/detail/lanes/lane_flat_walls.hpp"
#include "scintray/transport/detail/lanes/lane_in_box.hpp"
#include "scintray/transport/detail/lanes/lane_passes.hpp"
#include "scintray/transport/detail/lanes/lane_refraction.hpp"

namespace scintray::transport {

void propagate_lanes_4(const LanePlanes& planes, const LaneLimits& limits, LaneWork* const* photons,
                       std::size_t count) {
  if (planes.box) return propagate_in_box<core::LaneReal<xsimd::avx2>>(planes, limits, photons, count);
  propagate_between_planes<core::LaneReal<xsimd::avx2>>(planes, limits, photons, count);
}

void propagate_lanes_in_body_4(const LaneBody& body, const LaneLimits& limits, LaneWork* const* photons,
                               std::size_t count) {
  propagate_in_body<core::LaneReal<xsimd::avx2>>(body, limits, photons, count);
}

void refract_lanes_4(const LaneNormal* normals, LaneWork* const* photons, std::size_t count) {
  refract_at_faces<core::LaneReal<xsimd::avx2>>(normals, photons, count);
}

void run_lanes_4(LanePool& pool) { run_passes<core::LaneRealPair<xsimd::avx2>>(pool); }

}  // namespace scintray::transport
