#include "scintray/core/detail/normal_kernels_of.hpp"

namespace scintray::core {

void set_normals_4(NormalLanes& lanes) { set_normals<LaneRealPair<xsimd::avx2>>(lanes); }

}  // namespace scintray::core
