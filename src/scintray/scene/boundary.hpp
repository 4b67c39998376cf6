#pragma once
/// The boundary of a region as plain records, from which its rays are traced.

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "scintray/core/plain_vec.hpp"
#include "scintray/scene/exact_bodies.hpp"
#include "scintray/scene_file/run.hpp"

namespace scintray::scene {

/// Distance from a plane, relative to the region's size, within which vertices lie on it.
inline constexpr double kCoplanar = 1e-10;

/// A triangle of a region's boundary in the region's own frame; normals point out of the region.
using BoundaryTriangle = std::array<core::Vec3, 3>;

/// mm2
inline double area_of(const BoundaryTriangle& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

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

/// A boundary whose flat faces have fewer triangles: each covers triangles of the boundary that have one
/// plane and one label.
struct MergedTriangles {
  std::vector<std::uint32_t> corners;     ///< three a triangle, indices into Boundary::vertices
  std::vector<std::uint32_t> stands_for;  ///< a triangle of the boundary that it covers, or some of it

  bool empty() const { return corners.empty(); }
};

/// A box of the region with nothing in it, one side of which lies on a face of the boundary, and the opposite
/// one on the plane of a parallel face. A ray from that plane to the face hits nothing else where both ends
/// are in the box.
struct ThinGap {
  core::PlainVec3 x, y;  ///< axes of unit length in the planes, along the sides of the box
  double low_x = 0.0, high_x = 0.0, low_y = 0.0, high_y = 0.0;  ///< sides of the box, mm
  std::uint32_t beyond = 0;                                     ///< a triangle of the face

  /// Whether a point between the two planes is in the box.
  bool contains(double along_x, double along_y) const {
    return along_x >= low_x && along_x <= high_x && along_y >= low_y && along_y <= high_y;
  }
};
static_assert(std::is_trivially_copyable_v<ThinGap>);

/// The thin gaps of a region by the triangles from whose planes rays start.
struct ThinGaps {
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };
  std::vector<ThinGap> gaps;
  std::vector<Range> of_triangle;  ///< ranges of `gaps` by triangle of the boundary; empty: there are none

  bool empty() const { return gaps.empty(); }
};

/// The boundary of one shape of region as plain records, in the region's own frame (mm).
struct Boundary {
  std::vector<core::PlainVec3> vertices;  ///< each once: a third of the memory for a large mesh
  std::vector<std::uint32_t> corners;     ///< three a triangle, indices into `vertices`
  std::vector<TrianglePlane> triangle_planes;
  std::vector<BoundingPlane> planes;           ///< of a convex region with few; else empty
  std::uint32_t opposite_planes = 0;           ///< of these, the first: two by two with opposite normals
  bool is_box = false;                         ///< six planes, with the normals x, -x, y, -y, z and -z
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
