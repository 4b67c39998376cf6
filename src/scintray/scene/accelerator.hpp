#pragma once
/// Ray queries: the point at which a photon leaves a region. All use of Embree is in accelerator.cpp.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "scintray/core/lanes.hpp"
#include "scintray/core/plain_vec.hpp"
#include "scintray/scene/boundary.hpp"
#include "scintray/scene/exact_bodies.hpp"
#include "scintray/scene_file/run.hpp"

namespace scintray::scene {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// The point at which a ray leaves a region.
struct Exit {
  double distance_mm = 0.0;
  std::uint32_t triangle = kNoTriangle;  ///< kNoTriangle: the ray goes to infinity
  bool resolved = false;                 ///< resolved by the exact query
};

/// The first hit of a ray by Embree, in single precision.
struct FirstHit {
  float distance_mm = 0.0f;  ///< along the ray
  float unused = 0.0f;       ///< padding: distance and triangle are returned in registers
  std::uint32_t triangle = kNoTriangle;
  std::uint32_t unused_too = 0;
};

/// Approach of a ray to the plane of a triangle, in double precision.
struct Approach {
  double cosine = 0.0;       ///< between ray and normal; the ray leaves the region where positive
  double distance_mm = 0.0;  ///< along the ray; 0 where the plane lies behind. Only for a positive cosine
};

/// The boundary of one region, immutable, shared by regions of the same shape.
///
/// A photon is inside the region, so the normal of the next boundary triangle points along the ray. A result
/// that contradicts this (no triangle ahead in a closed region, or the next triangle entered from behind) is
/// a ray that passed an edge in single precision; it is resolved by the exact query, a search of all
/// triangles in double precision, so that no photon is lost.
class Accelerator {
 public:
  /// @param triangles boundary, mm, centred near the origin (Embree works in single precision)
  /// @param labels    target of each triangle; on a plane with one label any of its triangles may be returned
  /// @param closed    false for the ambient region, from which rays may escape
  /// @param kind      throws InputError for `planes` where they do not apply
  /// @param exact     round bodies that bound the region, for whose triangles they stand
  Accelerator(const std::vector<BoundaryTriangle>& triangles, const std::vector<std::uint32_t>& labels,
              bool closed, scene_file::AcceleratorKind kind, ExactBodies exact = {});
  /// An accelerator from the records of another.
  explicit Accelerator(Boundary boundary);
  ~Accelerator();
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;

  /// The point at which the ray from `origin` (inside the region or on its boundary) along the unit vector
  /// `direction` leaves the region.
  Exit find_exit(const core::Vec3& origin, const core::Vec3& direction) const;

  /// As find_exit, from the face of the triangle `left`, where it is across a thin gap from there that the
  /// ray leaves; kNoTriangle where it is not, or where this is not clear.
  Exit exit_across_gap(const core::Vec3& origin, const core::Vec3& direction, std::uint32_t left) const;
  bool has_thin_gaps() const { return !boundary_.thin_gaps.empty(); }

  /// As find_exit, of a region with exact bodies.
  /// @param left  triangle on whose face the ray starts, reflected: of a quadric the root there is known and
  ///              left out; kNoTriangle: not known
  Exit find_exact_exit(const core::Vec3& origin, const core::Vec3& direction, std::uint32_t left) const;
  bool has_exact_bodies() const { return !boundary_.exact.empty(); }
  /// Unit normal, out of the region, of the face of a triangle at a point next to it.
  core::Vec3 normal_at(std::uint32_t triangle, const core::Vec3& point) const;
  /// The normal, and the displacement (mm) of the point onto the face; zero for flat faces.
  mesh::Foot nearest_at(std::uint32_t triangle, const core::Vec3& point) const;

  /// find_exit in steps, for the propagation through total reflections, in which the next ray is available in
  /// single precision before it is in double: the first hit, the approach to it, and, where that does not
  /// leave the region or nothing is hit, exact_exit.
  bool uses_embree() const { return embree_ != nullptr; }
  /// @param origin_and_start  fourth: start_mm(); the others mm
  /// @param direction         fourth: 0
  /// Only where Embree is used.
  FirstHit first_hit(core::FourFloats origin_and_start, core::FourFloats direction) const;
  /// Distance (mm) from the origin at which rays start.
  double start_mm() const { return start_mm_; }
  /// @param origin  fourth: -1; @param direction  fourth: 0
  Approach approach_of(std::uint32_t triangle, const core::Lanes& origin,
                       const core::Lanes& direction) const {
    const core::Lanes plane = this->plane(triangle);
    const double cosine = dot(plane, direction);
    return {cosine, std::max(0.0, -dot(plane, origin) / cosine)};
  }
  [[gnu::cold]] Exit exact_exit(const core::Vec3& origin, const core::Vec3& direction, FirstHit hit) const;

  /// True when `point` is inside the boundary; of the ambient region, which has no end, when nothing else
  /// holds it.
  bool contains(const core::Vec3& point) const;

  /// Unit normal of a triangle, out of the region.
  const core::PlainVec3& normal(std::uint32_t triangle) const {
    return boundary_.triangle_planes[triangle].normal;
  }
  /// Plane of a triangle: the normal, and as the fourth its product with any point of the plane, mm.
  core::Lanes plane(std::uint32_t triangle) const {
    return core::Lanes::at(reinterpret_cast<const double*>(&boundary_.triangle_planes[triangle]));
  }
  std::size_t size() const { return boundary_.size(); }
  BoundaryTriangle triangle(std::uint32_t i) const { return boundary_.triangle(i); }
  bool uses_planes() const { return !boundary_.planes.empty(); }
  /// Whether the region is one convex body of planes and quadrics, and nothing else bounds it.
  bool is_convex_body() const {
    const ExactBodies& exact = boundary_.exact;
    return exact.held && exact.bodies.size() == 1 && exact.bodies.front().is_convex() && !embree_;
  }
  /// Whether it is that, and all its quadrics are cylinders.
  bool is_convex_cylinders() const { return convex_cylinders_; }
  /// 1 over the radius of a cylinder, 1/mm.
  static double inverse_radius(const mesh::SupportSurface& cylinder) {
    return 1.0 / std::sqrt(cylinder.radius2);
  }
  /// Number of distinct planes that bound the region, when it is convex.
  std::size_t plane_count() const { return boundary_.planes.size(); }
  /// All records of the accelerator; Embree's scene is made from them.
  const Boundary& boundary() const { return boundary_; }

 private:
  struct EmbreeScene;

  /// Result of one ray on whether a point is inside.
  enum class Inside { yes, no, no_hit, unclear };

  bool make_planes(const std::vector<std::uint32_t>& labels);
  Exit exit_by_planes(const core::Vec3& origin, const core::Vec3& direction) const;
  Exit exit_by_embree(const core::Vec3& origin, const core::Vec3& direction) const;
  /// Triangle of the surface that was hit whose region a point of it leads to.
  std::uint32_t triangle_at(const BodyHit& hit, const core::Vec3& point) const;
  /// Triangle of a round face that lies between a point of it and its centre or axis.
  std::uint32_t facet_at(std::uint32_t quadric, const core::Vec3& point) const;
  template <typename Outside>
  std::uint32_t nearest_of(const SurfaceTriangles& on, Outside outside_of) const;
  void index_facets();
  Exit exit_by_search(const core::Vec3& origin, const core::Vec3& direction) const;
  Inside inside_by_embree(const core::Vec3& point, const core::Vec3& direction) const;
  bool inside_by_search(const core::Vec3& point, const core::Vec3& direction) const;
  /// A triangle of the boundary that Embree's stands for.
  std::uint32_t searched(std::uint32_t number) const {
    return boundary_.merged.empty() ? number : boundary_.merged.stands_for[number];
  }
  /// Distance (mm) along the ray to the triangle's plane.
  double distance_to_plane(std::uint32_t triangle, const core::Vec3& origin,
                           const core::Vec3& direction) const {
    const TrianglePlane& plane = boundary_.triangle_planes[triangle];
    return (plane.offset - plane.normal.dot(origin)) / plane.normal.dot(direction);
  }

  Boundary boundary_;
  double start_mm_ = 0.0;  ///< distance from the origin at which rays start
  bool convex_cylinders_ = false;
  std::unique_ptr<EmbreeScene> embree_;
  std::vector<std::unique_ptr<EmbreeScene>> facets_;  ///< of round faces that lead to several regions
};

}  // namespace scintray::scene
