#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"

namespace scintray::transport {

void propagate_lanes_2(const LanePlanes& planes, const LaneLimits& limits, LaneWork* photons,
                       std::size_t count) {
  LanePropagation<xsimd::sse2>(planes, limits, photons, count).run();
}

}  // namespace scintray::transport
