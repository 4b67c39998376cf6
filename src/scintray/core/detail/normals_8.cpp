#include "scintray/core/detail/normal_kernels_of.hpp"

namespace scintray::core {

void draw_normals_8(NormalLanes& lanes) {
  draw_normals<LaneReal<xsimd::avx512f>, LaneDraws::in_lanes>(lanes);
}

}  // namespace scintray::core
