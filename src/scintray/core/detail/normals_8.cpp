#include "scintray/core/detail/normal_kernels_of.hpp"

namespace scintray::core {

void set_normals_8(NormalLanes& lanes) { set_normals<LaneReal<xsimd::avx512f>>(lanes); }

}  // namespace scintray::core
