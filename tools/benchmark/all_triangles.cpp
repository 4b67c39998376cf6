#include "all_triangles.hpp"

#include <array>

namespace scintray::bench {

namespace {

/// Distance behind the origin at which a plane still counts, relative to the region's size: what rounding of
/// the number type makes of an origin on a boundary.
constexpr double kBehindDouble = 1e-13, kBehindFloat = 1e-6;

/// The vector whose product with `edge` is 1, and with `other` and the normal 0.
core::Vec3 dual_of(const core::Vec3& edge, const core::Vec3& other, const core::Vec3& normal) {
  const core::Vec3 across = other.cross(normal);
  return across / across.dot(edge);
}

std::array<double, kTestNumbers> test_of(const scene::BoundaryTriangle& t,
                                         const scene::TrianglePlane& plane) {
  const core::Vec3 normal = plane.normal.vec();
  const core::Vec3 u = dual_of(t[1] - t[0], t[2] - t[0], normal),
                   v = dual_of(t[2] - t[0], t[1] - t[0], normal);
  return {normal.x(), normal.y(),   normal.z(), plane.offset, u.x(), u.y(),
          u.z(),      -u.dot(t[0]), v.x(),      v.y(),        v.z(), -v.dot(t[0])};
}

/// Tests of all triangles in blocks of `width`: number by number, in each the triangles of the block.
template <typename Real>
std::vector<Real> tests_of(const scene::Accelerator& region, std::size_t width) {
  const std::size_t blocks = (region.size() + width - 1) / width;
  std::vector<Real> tests(blocks * width * kTestNumbers, Real(0));
  for (std::size_t i = 0; i < region.size(); ++i) {
    const auto numbers =
        test_of(region.triangle(static_cast<std::uint32_t>(i)), region.boundary().triangle_planes[i]);
    for (std::size_t k = 0; k < kTestNumbers; ++k)
      tests[(i / width * kTestNumbers + k) * width + i % width] = static_cast<Real>(numbers[k]);
  }
  return tests;
}

template <typename Real>
TriangleTask<Real> task_of(const std::vector<Real>& tests, std::size_t triangles,
                           const std::array<std::vector<Real>, 6>& rays, double behind_mm, RayHits& hits) {
  TriangleTask<Real> task{};
  task.tests = tests.data();
  task.triangles = triangles;
  for (std::size_t k = 0; k < 6; ++k) task.rays[k] = rays[k].data();
  task.count = rays[0].size();
  task.behind_mm = static_cast<Real>(behind_mm);
  task.triangle = hits.triangle.data();
  task.distance_mm = hits.distance_mm.data();
  return task;
}

}  // namespace

std::vector<LaneWays> lane_ways() {
  std::vector<LaneWays> ways;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) {
    ways.push_back({"4 doubles", 4, false, {trace_triangles_in_4, trace_rays_in_4}, {}});
    ways.push_back({"8 floats", 8, true, {}, {trace_triangles_in_8, trace_rays_in_8}});
  }
  if (__builtin_cpu_supports("avx512f")) {
    ways.push_back({"8 doubles", 8, false, {trace_triangles_in_8, trace_rays_in_8}, {}});
    ways.push_back({"16 floats", 16, true, {}, {trace_triangles_in_16, trace_rays_in_16}});
  }
#endif
  return ways;
}

AllTriangles::AllTriangles(const scene::Accelerator& region, const LaneWays& ways)
    : ways_(ways),
      triangles_(region.size()),
      behind_mm_((ways.single_precision ? kBehindFloat : kBehindDouble) * region.boundary().size_mm) {
  for (std::size_t lanes = 0; lanes < 2; ++lanes) {
    const std::size_t width = static_cast<LanesOf>(lanes) == LanesOf::triangles ? ways.width : 1;
    if (ways.single_precision)
      floats_[lanes] = tests_of<float>(region, width);
    else
      doubles_[lanes] = tests_of<double>(region, width);
  }
}

void AllTriangles::trace(LanesOf lanes, const RaySet& rays, RayHits& hits) const {
  const auto i = static_cast<std::size_t>(lanes);
  if (ways_.single_precision)
    ways_.floats[i](task_of(floats_[i], triangles_, rays.floats, behind_mm_, hits));
  else
    ways_.doubles[i](task_of(doubles_[i], triangles_, rays.doubles, behind_mm_, hits));
}

}  // namespace scintray::bench
