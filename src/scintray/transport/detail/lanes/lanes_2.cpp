#include "scintray/transport/detail/lanes/lane_body_walls.hpp"
#include "scintray/transport/detail/lanes/lane_flat_walls.hpp"
#include "scintray/transport/detail/lanes/lane_in_box.hpp"

namespace scintray::transport {

void propagate_lanes_2(const LanePlanes& planes, const LaneLimits& limits, LaneWork* const* photons,
                       std::size_t count) {
  if (planes.box) return propagate_in_box<core::LaneReal<xsimd::sse2>>(planes, limits, photons, count);
  propagate_between_planes<core::LaneReal<xsimd::sse2>>(planes, limits, photons, count);
}

void propagate_lanes_in_body_2(const LaneBody& body, const LaneLimits& limits, LaneWork* const* photons,
                               std::size_t count) {
  propagate_in_body<core::LaneReal<xsimd::sse2>>(body, limits, photons, count);
}

}  // namespace scintray::transport
