#include "scintray/transport/detail/lanes/lane_passes.hpp"

namespace scintray::transport {

void run_lanes_2(LanePool& pool) { LanePasses<xsimd::sse2>(pool).run(); }

}  // namespace scintray::transport
