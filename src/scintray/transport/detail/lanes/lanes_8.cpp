#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"

namespace scintray::transport {

void propagate_lanes_8(const LanePlanes& planes, const LaneLimits& limits, LaneWork* photons,
                       std::size_t count) {
  LanePropagation<xsimd::avx512f>(planes, limits, photons, count).run();
}

}  // namespace scintray::transport
