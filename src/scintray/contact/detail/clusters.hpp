#pragma once
/// Clusters of coplanar faces of different parts, and the snapping of their vertices onto one plane.

#include <cstdint>
#include <utility>
#include <vector>

#include "scintray/contact/detail/geometry.hpp"

namespace scintray::contact {

/// A triangle of a body.
struct TriangleOf {
  std::uint32_t body;
  std::uint32_t triangle;
  auto operator<=>(const TriangleOf&) const = default;
};

/// Two bodies whose boxes come close, body a before body b.
struct BodyPair {
  std::uint32_t a, b;
  bool surfaces_near = false;                                     ///< boxes of some triangles intersect
  std::vector<std::pair<std::uint32_t, std::uint32_t>> parallel;  ///< near triangles, almost parallel
};

/// All pairs of bodies whose boxes are within `reach_mm`, in order.
std::vector<BodyPair> near_pairs(const std::vector<Body>& bodies, double reach_mm);

struct Plane {
  core::Vec3 origin = core::Vec3::Zero();
  core::Vec3 normal = core::Vec3::Zero();
  double height(const core::Vec3& p) const { return normal.dot(p - origin); }
};

/// A connected flat region of one body's surface.
struct Patch {
  std::uint32_t body;
  std::vector<std::uint32_t> triangles;
  Plane plane;
  double area = 0.0;
};

/// Flat faces of different bodies on one plane, connected by contacts.
struct Cluster {
  Plane plane;  ///< of its largest patch
  std::vector<std::uint32_t> patches;
};

struct Clusters {
  std::vector<Patch> patches;
  std::vector<Cluster> clusters;
  std::vector<std::vector<std::uint32_t>> patch_of;  ///< by body and triangle
  std::vector<std::int32_t> cluster_of;              ///< by patch; -1 when it touches nothing
  std::int32_t cluster(const TriangleOf& t) const { return cluster_of[patch_of[t.body][t.triangle]]; }
};

/// Splits every surface into flat patches and joins the patches of different bodies that are in contact:
/// nearer than the tolerance over an overlap wider than the tolerance.
/// @throws InputError when a chain of contacts deviates by more than twice the tolerance from one plane.
Clusters find_clusters(const std::vector<Body>& bodies, const std::vector<PlacedPart>& parts,
                       const std::vector<BodyPair>& pairs, double tolerance_mm);

/// Moves the vertices of touching faces onto their common planes, and corners and edges of different
/// bodies that lie within the tolerance onto each other, so that contacts close and no slivers arise.
/// Vertices that agree to `rounding_mm` are unchanged.
void snap(std::vector<Body>& bodies, const Clusters& clusters, double tolerance_mm, double rounding_mm);

/// Area (mm2) and perimeter (mm) of the overlap of two triangles projected along a plane's normal.
struct Overlap {
  double area = 0.0;
  double perimeter = 0.0;
  /// Width of the strip with this area and perimeter, mm.
  double width() const { return perimeter > 0.0 ? 2.0 * area / perimeter : 0.0; }
};
Overlap overlap(const Body& a, std::uint32_t triangle_a, const Body& b, std::uint32_t triangle_b,
                const Plane& plane);

}  // namespace scintray::contact
