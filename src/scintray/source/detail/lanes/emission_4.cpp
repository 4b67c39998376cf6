#include "scintray/source/detail/lanes/emission_kernels_of.hpp"

namespace scintray::source {

EmissionKernels emission_kernels_4() { return EmissionKernelsOf<core::LaneRealPair<xsimd::avx2>>::all(); }

}  // namespace scintray::source
