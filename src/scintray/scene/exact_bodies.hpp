#pragma once
/// Convex bodies bounded by planes and quadrics, and their intersections with rays by formulas.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include "scintray/mesh/support_surface.hpp"

namespace scintray::scene {

inline constexpr std::uint32_t kNoSurface = 0xffffffffu;

/// q along a ray, with t the distance (mm): q(t) = a t^2 + 2 b t + c.
struct QuadricOnRay {
  double a, b, c;
};

inline QuadricOnRay on_ray(const mesh::SupportSurface& s, const core::Vec3& origin,
                           const core::Vec3& direction) {
  const core::Vec3 w = origin - s.origin;
  const double z = s.axis.dot(w), dz = s.axis.dot(direction);
  const core::Vec3 rho = w - z * s.axis.vec(), across = direction - dz * s.axis.vec();
  return {across.squaredNorm() + s.axial * dz * dz, rho.dot(across) + (s.axial * z - s.slope) * dz,
          rho.squaredNorm() + (s.axial * z - 2.0 * s.slope) * z - s.radius2};
}

/// Distance (mm) at which a ray from inside a convex quadric, or from on it, leaves it; infinite where it
/// does not. The point is inside, so that c is not positive but for rounding, which leaves one root ahead:
/// with c = 0 for the surface that the ray has just been reflected at, it is the other root, -2 b / a, or 0
/// for a ray that points outwards.
inline double distance_out(const QuadricOnRay& q) {
  const double root = std::sqrt(std::max(0.0, q.b * q.b - q.a * q.c));
  if (q.b > 0.0) return std::max(0.0, -q.c / (q.b + root));
  return q.a > 0.0 ? std::max(0.0, (root - q.b) / q.a) : std::numeric_limits<double>::infinity();
}

/// The part of a ray's line that is inside a convex set: distances (mm) from low to high; empty where low is
/// not below high.
struct Chord {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// The chord of a ray's line in a quadric, of a cone in its own nappe.
Chord chord_in(const mesh::SupportSurface& s, const QuadricOnRay& q, const core::Vec3& origin,
               const core::Vec3& direction);

/// The triangles of a region's boundary that lie on one surface of a body.
struct SurfaceTriangles {
  std::uint32_t first = kNoSurface;  ///< one of them; kNoSurface: there is none
  /// Where they lead to different regions, all of them: a range of ExactBodies::triangles; else empty.
  std::uint32_t begin = 0, end = 0;
  /// Of this range, the first lie under the end of another body, whose exact outline decides: a range of
  /// ExactBodies::outlines.
  std::uint32_t outlines_begin = 0, outlines_end = 0;
};

struct BodyPlane {
  core::PlainVec3 normal;  ///< unit, out of the body
  double offset = 0.0;     ///< normal . x on the plane
  SurfaceTriangles on;
};

struct BodyQuadric {
  mesh::SupportSurface surface;
  SurfaceTriangles on;
};

/// A convex body: the space inside all of its planes and quadrics.
struct ConvexBody {
  std::uint32_t planes_begin = 0, planes_end = 0;
  std::uint32_t quadrics_begin = 0, quadrics_end = 0;
  std::uint32_t first = kNoSurface;  ///< a triangle of the region's boundary on it
  core::PlainVec3 low, high;         ///< corners of a box around it, mm
};

/// A node of the tree of the bodies cut out of a region: a box around some of them.
struct BodyNode {
  core::PlainVec3 low, high;         ///< mm
  std::uint32_t begin = 0, end = 0;  ///< of a leaf: a range of ExactBodies::in_leaves; else empty
  std::uint32_t second = 0;          ///< of two children; the first is the next node
};

/// The outline of a body's flat end in a plane: a point of the plane is under it where it is inside all of
/// these quadrics.
struct EndOutline {
  std::uint32_t triangle = 0;  ///< of the region's boundary, under the end
  std::uint32_t quadrics_begin = 0, quadrics_end = 0;
};

/// Where a ray reaches a body.
struct BodyHit {
  double distance_mm = std::numeric_limits<double>::infinity();
  const SurfaceTriangles* on = nullptr;  ///< null: it does not
  std::uint32_t first = kNoSurface;      ///< a triangle of the body, where its surface has none of its own
  std::uint32_t body = 0;                ///< number of the body
};

/// The convex bodies that bound a region, in its frame (mm), as plain records: the body that holds the
/// region, where this is one of them, and bodies cut out of it. A region's boundary has its other triangles
/// first.
///
/// A body that is the intersection of the insides of its surfaces is hit by a ray from outside where the ray
/// has entered all of these, and left where it leaves the first of them. Which it is, is known from the
/// region that the photon is in, so that no distance is compared with a tolerance.
struct ExactBodies {
  std::vector<ConvexBody> bodies;  ///< the one that holds the region, if any, then the holes, largest first
  std::vector<BodyPlane> planes;
  std::vector<BodyQuadric> quadrics;
  std::vector<std::uint32_t> triangles;          ///< ranges of SurfaceTriangles
  std::vector<EndOutline> outlines;              ///< ranges of SurfaceTriangles
  std::vector<mesh::SupportSurface> outline_of;  ///< ranges of EndOutline
  /// Per triangle of the region's boundary, its quadric; kNoSurface: flat.
  std::vector<std::uint32_t> quadric_of;
  std::vector<BodyNode> nodes;           ///< tree of the holes, the root first; empty where they are few
  std::vector<std::uint32_t> in_leaves;  ///< numbers of bodies: ranges of BodyNode
  std::uint32_t meshed = 0;              ///< triangles of the boundary that are on none of the bodies
  bool held = false;                     ///< the first body holds the region

  bool empty() const { return bodies.empty(); }
  /// Builds the tree of the holes, once all bodies are there.
  void build_tree();
  /// Whether a point (mm) is inside the region, as far as the bodies decide it.
  bool admit(const core::Vec3& point) const;
  bool contains(const ConvexBody& body, const core::Vec3& point) const;
  /// The nearest surface that a ray from inside the region reaches.
  /// @param left  quadric on which the ray starts, known to be a root at 0; kNoSurface: not known
  BodyHit nearest(const core::Vec3& origin, const core::Vec3& direction, std::uint32_t left) const;
  /// Whether the quadric is a wall of the body that holds the region, which has the region inside.
  bool has_region_inside(std::uint32_t quadric) const {
    return held && quadric < bodies.front().quadrics_end;
  }

 private:
  struct Ray {
    core::Vec3 origin, direction, inverse;
    std::uint32_t left;
  };
  void leave(const ConvexBody& body, const Ray& ray, BodyHit& nearest) const;
  void enter(std::uint32_t number, const Ray& ray, BodyHit& nearest) const;
  void enter_any(const Ray& ray, BodyHit& nearest) const;
  void add_node(std::uint32_t begin, std::uint32_t end);
};

}  // namespace scintray::scene
