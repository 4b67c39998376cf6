#pragma once
/// Finds where a photon leaves a region. Everything Embree is in accelerator.cpp.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray {

/// Which algorithm answers ray queries.
enum class AcceleratorKind {
  automatic,  ///< planes where they apply, else Embree
  embree,     ///< Embree's bounding volume hierarchy, single rays, corrected in double precision
  planes,     ///< the nearest plane ahead, for closed regions: all must be convex with few planes
};

/// A triangle of a region's boundary in the region's own frame; normals point out of the region.
using BoundaryTriangle = std::array<Vec3, 3>;

/// Triangles with every vertex once: a third of the memory for a large mesh.
struct IndexedTriangles {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corners;  ///< three a triangle

  explicit IndexedTriangles(const std::vector<BoundaryTriangle>& triangles);
  std::size_t size() const { return corners.size() / 3; }
  BoundaryTriangle operator[](std::size_t i) const {
    return {vertices[corners[3 * i]], vertices[corners[3 * i + 1]], vertices[corners[3 * i + 2]]};
  }
};

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// Where a ray leaves a region.
struct Exit {
  double distance_mm = 0.0;
  std::uint32_t triangle = kNoTriangle;  ///< kNoTriangle: the ray goes to infinity
  bool resolved = false;                 ///< settled by the exact search
};

/// The boundary of one region, immutable, shared by regions of the same shape.
///
/// A photon is inside the region, so the boundary it meets next has its normal along the ray. An
/// answer that contradicts this - nothing ahead in a closed region, or the next triangle entered from
/// behind - is a ray that slipped through an edge in single precision; it is settled by a search of
/// all triangles in double precision, so no photon is ever lost.
class Accelerator {
 public:
  /// @param triangles boundary, mm, centred near the origin (Embree works in single precision)
  /// @param labels    what each triangle leads to; on a plane with one label any triangle of it may
  ///                  be returned
  /// @param closed    false for the ambient region, from which rays may escape
  /// @param kind      throws InputError for `planes` where they do not apply
  Accelerator(const std::vector<BoundaryTriangle>& triangles, const std::vector<std::uint32_t>& labels,
              bool closed, AcceleratorKind kind);
  ~Accelerator();
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;

  /// Where the ray from `origin` (inside the region or on its boundary) along the unit vector
  /// `direction` leaves the region.
  Exit find_exit(const Vec3& origin, const Vec3& direction) const {
    return find_exit(origin.x(), origin.y(), origin.z(), direction.x(), direction.y(), direction.z());
  }
  /// The same from coordinates, which travel in registers: through memory a step in a box takes 4 % longer.
  Exit find_exit(double x, double y, double z, double direction_x, double direction_y,
                 double direction_z) const;

  /// True when `point` is inside the (closed) boundary.
  bool contains(const Vec3& point) const;

  /// Unit normal of a triangle, out of the region.
  const Vec3& normal(std::uint32_t triangle) const { return triangle_planes_[triangle].normal; }
  std::size_t size() const { return triangles_.size(); }
  BoundaryTriangle triangle(std::uint32_t i) const { return triangles_[i]; }
  bool uses_planes() const { return !planes_.empty(); }
  /// Triangles whose planes bound the region, when it is convex: the number of distinct planes.
  std::size_t plane_count() const { return planes_.size(); }

 private:
  struct TrianglePlane {
    Vec3 normal;
    double offset;  ///< normal . x on the plane
  };
  struct Plane {
    Vec3 normal;
    double offset;                         ///< normal . x on the plane
    std::uint32_t first;                   ///< a triangle on the plane
    std::vector<std::uint32_t> triangles;  ///< all of them when they lead to different places
  };
  struct EmbreeScene;

  /// What one ray says of a point.
  enum class Inside { yes, no, nothing_met, unclear };

  bool make_planes(const std::vector<std::uint32_t>& labels);
  Exit exit_by_planes(const Vec3& origin, const Vec3& direction) const;
  Exit exit_by_embree(double x, double y, double z, double direction_x, double direction_y,
                      double direction_z) const;
  Exit exit_by_search(const Vec3& origin, const Vec3& direction) const;
  Inside inside_by_embree(const Vec3& point, const Vec3& direction) const;
  bool inside_by_search(const Vec3& point, const Vec3& direction) const;
  /// Along the ray to the triangle's plane.
  double distance_to_plane(std::uint32_t triangle, const Vec3& origin, const Vec3& direction) const {
    const TrianglePlane& plane = triangle_planes_[triangle];
    return (plane.offset - plane.normal.dot(origin)) / plane.normal.dot(direction);
  }

  IndexedTriangles triangles_;
  std::vector<TrianglePlane> triangle_planes_;
  std::vector<Plane> planes_;
  std::unique_ptr<EmbreeScene> embree_;
  double size_mm_ = 0.0;  ///< diagonal of the bounding box
  bool closed_ = true;
};

}  // namespace scintray
