#include "scintray/core/detail/normal_kernels_of.hpp"

namespace scintray::core {

void draw_normals_4(NormalLanes& lanes) { draw_normals<LaneRealPair<xsimd::avx2>>(lanes); }

}  // namespace scintray::core
