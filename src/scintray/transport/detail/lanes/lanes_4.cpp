#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"
#include "scintray/transport/detail/lanes/lane_passes.hpp"

namespace scintray::transport {

void propagate_lanes_4(const LanePlanes& planes, const LaneLimits& limits, LaneWork* photons,
                       std::size_t count) {
  LanePropagation<xsimd::avx2>(planes, limits, photons, count).run();
}

void run_lanes_4(LanePool& pool) { LanePasses<LaneRealPair<xsimd::avx2>, LaneDraws::one_by_one>(pool).run(); }

}  // namespace scintray::transport
