#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"

namespace scintray::transport {

void propagate_lanes_4(const LanePlanes& planes, const LaneLimits& limits, LaneWork* photons,
                       std::size_t count) {
  LanePropagation<xsimd::avx2>(planes, limits, photons, count).run();
}

}  // namespace scintray::transport
