#pragma once
/// Bodies bounded by planes, quadrics of revolution and tori, and their intersections with rays by formulas.

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

/// q along a ray.
using QuadricOnRay = mesh::QuadricOnRayOf<double>;
inline QuadricOnRay on_ray(const mesh::SupportSurface& s, const core::Vec3& origin,
                           const core::Vec3& direction) {
  return s.numbers().on_ray(core::triple(origin), core::triple(direction));
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
  /// What lies under the faces of other bodies, whose exact outlines decide before that range: a range of
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
  bool around_region = false;  ///< the region is on the side of its inside
};

/// Where a function of the place is above zero: beyond a plane, or outside a support surface.
struct Trim {
  core::PlainVec3 normal;              ///< unit, of a plane
  double offset = 0.0;                 ///< of the plane
  std::uint32_t surface = kNoSurface;  ///< in ExactBodies::trim_surfaces; kNoSurface: a plane
  bool above = false;                  ///< side on which the face is, where it is one cell
};

/// Boxes, of equal size, into which that around a face with many trims is divided. In each of them most trims
/// have one sign all over, so that only the others are evaluated.
struct TrimGrid {
  core::PlainVec3 low, per_mm;           ///< corner of the first box (mm), boxes per mm
  std::array<std::uint32_t, 3> count{};  ///< boxes by axis
  std::uint32_t first = 0;               ///< in ExactBodies::trim_boxes; x runs first
};

/// A box of a TrimGrid.
struct TrimBox {
  /// Trims to evaluate: a range of ExactBodies::asked_trims; kNoSurface: the face is not in this box.
  std::uint32_t begin = 0, end = 0;
};

/// A face of a body that is not convex: the cells of its surface, cut by functions of the place, that it
/// consists of. Its edges are where these functions are zero, exactly.
struct TrimmedFace {
  core::PlainVec3 low, high;                               ///< corners of a box around it, mm
  std::uint32_t plane = kNoSurface, quadric = kNoSurface;  ///< one of them: its surface
  bool wall = false;                                       ///< the body is outside of the quadric
  std::uint32_t trims_begin = 0, trims_end = 0;            ///< a range of ExactBodies::trims
  /// Of several cells, their signs, sorted: bit k is set above zero of trim k, of 64 at most. Empty: one
  /// cell.
  std::uint32_t cells_begin = 0, cells_end = 0;
  std::uint32_t grid = kNoSurface;  ///< in ExactBodies::trim_grids, of one cell with many trims
};

/// A body: the space inside all of its planes and quadrics, where it is convex; else what its faces enclose.
struct ExactBody {
  std::uint32_t planes_begin = 0, planes_end = 0;
  std::uint32_t quadrics_begin = 0, quadrics_end = 0;
  std::uint32_t first = kNoSurface;              ///< a triangle of the region's boundary on it
  core::PlainVec3 low, high;                     ///< corners of a box around it, mm
  std::uint32_t faces_begin = 0, faces_end = 0;  ///< where it is not convex
  /// Of many faces the few whose boxes have a twentieth or more of the surface of the body's box, with which
  /// a ray is compared before the others: a range of ExactBodies::faces_in_leaves.
  std::uint32_t large_begin = 0, large_end = 0;
  std::uint32_t root = kNoSurface;  ///< in ExactBodies::face_nodes, of a body with many faces
  double rounding_mm = 0.0;         ///< of positions
  double off_surface_mm = 0.0;      ///< largest distance of what touches it from its surfaces

  bool is_convex() const { return faces_begin == faces_end; }
};

/// A node of a tree: a box around some of the bodies cut out of a region, or some faces of a body.
struct BodyNode {
  core::PlainVec3 low, high;         ///< mm
  std::uint32_t begin = 0, end = 0;  ///< of a leaf: a range of the numbers in leaves; else empty
  std::uint32_t second = 0;          ///< of two children; the first is the next node
};

/// The outline of a body's face on the surface of another: a point of the surface is under it where it is on
/// this face, or, at the flat end of a convex body, inside all of these quadrics.
struct EndOutline {
  std::uint32_t triangle = 0;  ///< of the region's boundary, under the end
  std::uint32_t quadrics_begin = 0, quadrics_end = 0;
  std::uint32_t face = kNoSurface;  ///< in ExactBodies::faces
};

/// Where a ray reaches a body.
struct BodyHit {
  double distance_mm = std::numeric_limits<double>::infinity();
  const SurfaceTriangles* on = nullptr;  ///< null: it does not
  std::uint32_t first = kNoSurface;      ///< a triangle of the body, where its surface has none of its own
  std::uint32_t body = 0;                ///< number of the body
  bool resolved = false;                 ///< by a search of all faces
};

/// The bodies that bound a region, in its frame (mm), as plain records: the body that holds the
/// region, where this is one of them, and bodies cut out of it. A region's boundary has its other triangles
/// first.
///
/// A body that is the intersection of the insides of its surfaces is hit by a ray from outside where the ray
/// has entered all of these, and left where it leaves the first of them. Which it is, is known from the
/// region that the photon is in, so that no distance is compared with a tolerance.
///
/// Of any other body, the nearest crossing of a surface on one of its faces counts. That it leads out, or in,
/// is known from the region: a crossing that contradicts this is of a ray that passed an edge within
/// rounding, and a search of all faces resolves it.
struct ExactBodies {
  std::vector<ExactBody> bodies;  ///< the one that holds the region, if any, then the holes, largest first
  std::vector<BodyPlane> planes;
  std::vector<BodyQuadric> quadrics;
  std::vector<std::uint32_t> triangles;          ///< ranges of SurfaceTriangles
  std::vector<EndOutline> outlines;              ///< ranges of SurfaceTriangles
  std::vector<mesh::SupportSurface> outline_of;  ///< ranges of EndOutline
  /// Per triangle of the region's boundary, its quadric; kNoSurface: flat.
  std::vector<std::uint32_t> quadric_of;
  std::vector<BodyNode> nodes;           ///< tree of the holes, the root first; empty where they are few
  std::vector<std::uint32_t> in_leaves;  ///< numbers of bodies: ranges of BodyNode
  std::vector<TrimmedFace> faces;
  std::vector<Trim> trims;                          ///< ranges of TrimmedFace
  std::vector<mesh::SupportSurface> trim_surfaces;  ///< of trims
  std::vector<std::uint64_t> cells;                 ///< ranges of TrimmedFace
  std::vector<TrimGrid> trim_grids;
  std::vector<TrimBox> trim_boxes;             ///< ranges of TrimGrid
  std::vector<std::uint32_t> asked_trims;      ///< numbers of trims: ranges of TrimBox
  std::vector<BodyNode> face_nodes;            ///< a tree for each body with many faces
  std::vector<std::uint32_t> faces_in_leaves;  ///< numbers of faces: ranges of its BodyNode
  std::uint32_t meshed = 0;                    ///< triangles of the boundary that are on none of the bodies
  bool held = false;                           ///< the first body holds the region

  bool empty() const { return bodies.empty(); }
  /// Builds the tree of the holes, once all bodies are there.
  void build_tree();
  /// Whether a point (mm) is inside the region, as far as the bodies decide it.
  bool admit(const core::Vec3& point) const;
  bool contains(const ExactBody& body, const core::Vec3& point) const;
  /// Distance (mm) of a point from the faces of a body that is not convex, to first order; infinite where
  /// none is beside it.
  double distance_to_faces(const ExactBody& body, const core::Vec3& point) const;
  /// Whether a point (mm) of a face's surface is within its outline.
  bool is_within(const TrimmedFace& face, const core::Vec3& point) const;
  /// Whether a ray from outside a body that is not convex leads into it and out of it in turn.
  bool alternates(const ExactBody& body, core::Vec3 origin, const core::Vec3& direction) const;
  /// Builds the tree of the faces of a body, where they are many.
  void build_face_tree(ExactBody& body);
  /// Builds the grid of the trims of a face, where they are many.
  void build_trim_grid(TrimmedFace& face);
  /// The nearest surface that a ray from inside the region reaches.
  /// @param left  quadric on which the ray starts, known to be a root at 0; kNoSurface: not known
  BodyHit nearest(const core::Vec3& origin, const core::Vec3& direction, std::uint32_t left) const;

 private:
  struct Ray {
    core::Vec3 origin, direction, inverse;
    std::uint32_t left;
  };
  /// A crossing of a face.
  struct FaceCrossing {
    double distance_mm = std::numeric_limits<double>::infinity();
    std::uint32_t face = kNoSurface;
    bool outwards = false;
  };
  /// Crossings that count: outwards or inwards ones from -rounding on, the others from `others_from` on.
  struct Wanted {
    bool outwards;
    double others_from;
  };
  void leave(const ExactBody& body, const Ray& ray, BodyHit& nearest) const;
  void enter(std::uint32_t number, const Ray& ray, BodyHit& nearest) const;
  void enter_any(const Ray& ray, BodyHit& nearest) const;

  /// Calls `consider(distance in mm, whether it leads out of the body)` for each crossing of a face's
  /// surface, of a torus of those between two distances.
  template <typename Consider>
  void for_each_crossing(const TrimmedFace& face, const Ray& ray, double low, double high,
                         const Consider& consider) const;
  double value_of(const Trim& trim, const core::Vec3& point) const {
    return trim.surface == kNoSurface ? trim.normal.dot(point) - trim.offset
                                      : trim_surfaces[trim.surface].value(point);
  }
  TrimBox trims_to_ask(const TrimmedFace& face, const core::Vec3& centre, const core::Vec3& half);
  /// The box of a grid with a point in it; null outside of all.
  const TrimBox* box_at(const TrimGrid& grid, const core::Vec3& point) const;
  void cross_faces(std::uint32_t number, bool outwards, const Ray& ray, BodyHit& nearest) const;
  FaceCrossing nearest_crossing(const ExactBody& body, const Ray& ray, const Wanted& wanted,
                                double limit) const;
  void cross_face(std::uint32_t number, const ExactBody& body, const Ray& ray, const Wanted& wanted,
                  FaceCrossing& nearest) const;
  FaceCrossing search_faces(const ExactBody& body, const Ray& ray, bool outwards, double limit) const;
  bool encloses(const ExactBody& body, const core::Vec3& point) const;
  double distance_from_outline(const TrimmedFace& face, const core::Vec3& point) const;
  const SurfaceTriangles& triangles_of(const TrimmedFace& face) const;
};

/// Whether a ray reaches a box within distances (mm) from `near` to `far`, which become those in the box.
/// Products of 0 and an infinite inverse, of a ray in a side of the box, are no number: they change neither.
inline bool reaches(const core::PlainVec3& low, const core::PlainVec3& high, const core::Vec3& origin,
                    const core::Vec3& inverse, double& near, double& far) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = inverse[axis] < 0.0;
    const double first = ((backwards ? high : low)[axis] - origin[axis]) * inverse[axis];
    const double last = ((backwards ? low : high)[axis] - origin[axis]) * inverse[axis];
    near = first > near ? first : near;
    far = last < far ? last : far;
  }
  return near <= far;
}

}  // namespace scintray::scene
