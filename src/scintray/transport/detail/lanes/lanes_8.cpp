#include "scintray/transport/detail/lanes/lane_passes.hpp"

namespace scintray::transport {

void run_lanes_8(LanePool& pool) { LanePasses<xsimd::avx512f>(pool).run(); }

}  // namespace scintray::transport
