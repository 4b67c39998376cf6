#include "scintray/core/detail/normal_kernels_of.hpp"

namespace scintray::core {

void draw_normals_8(NormalLanes& lanes) { draw_normals<LaneReal<xsimd::avx512f>>(lanes); }

}  // namespace scintray::core
