#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"
#include "scintray/transport/detail/lanes/lane_passes.hpp"

namespace scintray::transport {

void propagate_lanes_8(const LanePlanes& planes, const LaneLimits& limits, LaneWork* photons,
                       std::size_t count) {
  LanePropagation<xsimd::avx512f>(planes, limits, photons, count).run();
}

void run_lanes_8(LanePool& pool) {
  LanePasses<LaneRealPair<xsimd::avx512f>, LaneDraws::in_lanes>(pool).run();
}

}  // namespace scintray::transport
