#include "scintray/core/detail/normal_kernels_of.hpp"

namespace scintray::core {

void draw_normals_4(NormalLanes& lanes) {
  draw_normals<LaneRealPair<xsimd::avx2>, LaneDraws::one_by_one>(lanes);
}

}  // namespace scintray::core
