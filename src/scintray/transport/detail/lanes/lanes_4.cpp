#include "scintray/transport/detail/lanes/lane_passes.hpp"

namespace scintray::transport {

void run_lanes_4(LanePool& pool) { LanePasses<xsimd::avx2>(pool).run(); }

}  // namespace scintray::transport
