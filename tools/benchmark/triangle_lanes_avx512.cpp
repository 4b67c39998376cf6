// Compiled with AVX-512; -ffp-contract=off leaves products and sums apart, as in the lanes of transport.

#include "triangle_lanes_kernel.hpp"

namespace scintray::bench {

void trace_triangles_in_8(const TriangleTask<double>& task) {
  LaneKernel<xsimd::batch<double, xsimd::avx512f>>::trace_triangles(task);
}

void trace_rays_in_8(const TriangleTask<double>& task) {
  LaneKernel<xsimd::batch<double, xsimd::avx512f>>::trace_rays(task);
}

void trace_triangles_in_16(const TriangleTask<float>& task) {
  LaneKernel<xsimd::batch<float, xsimd::avx512f>>::trace_triangles(task);
}

void trace_rays_in_16(const TriangleTask<float>& task) {
  LaneKernel<xsimd::batch<float, xsimd::avx512f>>::trace_rays(task);
}

}  // namespace scintray::bench
