#pragma once
/// The boundary of a region as plain records, from which its rays are traced.

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "scintray/core/plain_vec.hpp"
#include "scintray/scene/exact_bodies.hpp"
#include "scintray/scene/flat_faces.hpp"
#include "scintray/scene/thin_gaps.hpp"
#include "scintray/scene_file/run.hpp"

namespace scintray::scene {

/// Distance from a plane, relative to the region's size, within which vertices lie on it.
inline constexpr double kCoplanar = 1e-10;

/// A triangle of a region's boundary in the region's own frame; normals point out of the region.
using BoundaryTriangle = std::array<core::Vec3, 3>;

/// The plane of a triangle.
struct TrianglePlane {
  core::PlainVec3 normal;  ///< unit, out of the region
  double offset;           ///< normal . x on the plane
};
static_assert(std::is_trivially_copyable_v<TrianglePlane> && sizeof(TrianglePlane) == 4 * sizeof(double));

/// A plane that bounds a convex region.
struct BoundingPlane {
  core::PlainVec3 normal;           ///< unit, out of the region
  double offset;                    ///< normal . x on the plane
  std::uint32_t first;              ///< a triangle on the plane
  std::uint32_t triangles_begin;    ///< all triangles on it, where these lead to different regions: a
  std::uint32_t triangles_end = 0;  ///< range of Boundary::plane_triangles; empty: all lead to one
};
static_assert(std::is_trivially_copyable_v<BoundingPlane>);

/// The boundary of one shape of region as plain records, in the region's own frame (mm).
struct Boundary {
  std::vector<core::PlainVec3> vertices;  ///< each once: a third of the memory for a large mesh
  std::vector<std::uint32_t> corners;     ///< three a triangle, indices into `vertices`
  std::vector<TrianglePlane> triangle_planes;
  std::vector<BoundingPlane> planes;           ///< of a convex region with few; else empty
  std::uint32_t opposite_planes = 0;           ///< of these, the first: two by two with opposite normals
  std::vector<std::uint32_t> plane_triangles;  ///< ranges of BoundingPlane
  ExactBodies exact;                           ///< round bodies; empty: all triangles are faces as they are
  MergedTriangles merged;                      ///< that Embree searches; empty: the triangles as they are
  ThinGaps thin_gaps;                          ///< between flat faces, where Embree searches
  double size_mm = 0.0;                        ///< diagonal of the bounding box
  bool closed = true;  ///< by the triangles that are not on exact bodies; false for the ambient region

  std::size_t size() const { return triangle_planes.size(); }
  /// Number of triangles, the first ones, that are faces as they are.
  std::size_t meshed() const { return exact.empty() ? size() : exact.meshed; }
  BoundaryTriangle triangle(std::size_t i) const {
    return {vertices[corners[3 * i]], vertices[corners[3 * i + 1]], vertices[corners[3 * i + 2]]};
  }
};

/// Records of a boundary.
/// @param triangles boundary, mm, centred near the origin
/// @param labels    target of each triangle; on a plane with one label any of its triangles may be returned
/// @param closed    false for the ambient region, from which rays may escape
/// @param kind      throws InputError for `planes` where they do not apply
/// @param exact     round bodies that bound the region, for whose triangles they stand
Boundary make_boundary(const std::vector<BoundaryTriangle>& triangles,
                       const std::vector<std::uint32_t>& labels, bool closed,
                       scene_file::AcceleratorKind kind, ExactBodies exact);

}  // namespace scintray::scene
