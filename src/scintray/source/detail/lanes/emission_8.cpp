#include "scintray/source/detail/lanes/emission_kernels_of.hpp"

namespace scintray::source {

EmissionKernels emission_kernels_8() { return EmissionKernelsOf<core::LaneReal<xsimd::avx512f>>::all(); }

}  // namespace scintray::source
