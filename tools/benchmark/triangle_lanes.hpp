#pragma once
/// Kernels that test rays against all triangles in lanes; compiled for each instruction set.

#include <cstddef>
#include <cstdint>

namespace scintray::bench {

/// Numbers of the test of a triangle: its plane (unit normal out of the region, and its product with any
/// point of the plane), then two barycentric coordinates as linear functions of a point (vector and
/// constant).
inline constexpr std::size_t kTestNumbers = 12;

/// Rays and triangles of a kernel, and where the hits go.
template <typename Real>
struct TriangleTask {
  const Real* tests;  ///< by triangle; where lanes hold triangles, by blocks of lanes, filled up with zeros
  std::size_t triangles;  ///< without those that fill up
  const Real* rays[6];    ///< x, y and z of the origins (mm), then of the directions
  std::size_t count;      ///< of rays, a multiple of the lanes
  Real behind_mm;         ///< distance behind the origin up to which a plane may lie, by rounding
  std::uint32_t* triangle;
  float* distance_mm;
};

template <typename Real>
using TriangleKernel = void (*)(const TriangleTask<Real>&);

void trace_triangles_in_4(const TriangleTask<double>& task);
void trace_triangles_in_8(const TriangleTask<double>& task);
void trace_triangles_in_8(const TriangleTask<float>& task);
void trace_triangles_in_16(const TriangleTask<float>& task);

void trace_rays_in_4(const TriangleTask<double>& task);
void trace_rays_in_8(const TriangleTask<double>& task);
void trace_rays_in_8(const TriangleTask<float>& task);
void trace_rays_in_16(const TriangleTask<float>& task);

}  // namespace scintray::bench
