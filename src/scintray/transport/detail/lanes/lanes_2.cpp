#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"
#include "scintray/transport/detail/lanes/lane_passes.hpp"

namespace scintray::transport {

void propagate_lanes_2(const LanePlanes& planes, const LaneLimits& limits, LaneWork* photons,
                       std::size_t count) {
  LanePropagation<xsimd::sse2>(planes, limits, photons, count).run();
}

void run_lanes_2(LanePool& pool) { LanePasses<xsimd::sse2>(pool).run(); }

}  // namespace scintray::transport
