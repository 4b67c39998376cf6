// Compiled with AVX2 and without multiply-add, as the lanes of transport.

#include "triangle_lanes_kernel.hpp"

namespace scintray::bench {

void trace_triangles_in_4(const TriangleTask<double>& task) {
  LaneKernel<xsimd::batch<double, xsimd::avx2>>::trace_triangles(task);
}

void trace_rays_in_4(const TriangleTask<double>& task) {
  LaneKernel<xsimd::batch<double, xsimd::avx2>>::trace_rays(task);
}

void trace_triangles_in_8(const TriangleTask<float>& task) {
  LaneKernel<xsimd::batch<float, xsimd::avx2>>::trace_triangles(task);
}

void trace_rays_in_8(const TriangleTask<float>& task) {
  LaneKernel<xsimd::batch<float, xsimd::avx2>>::trace_rays(task);
}

}  // namespace scintray::bench
