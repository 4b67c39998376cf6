#pragma once
/// Parts as bodies with exact round faces, the regions between them, and the description of both.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/scene/detail/assemble.hpp"
#include "scintray/scene/exact_bodies.hpp"

namespace scintray::scene {

using Corners = std::array<core::Vec3, 3>;

/// Normal of a triangle times twice its area, mm2.
inline core::Vec3 doubled_area(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// A plane in world coordinates.
struct WorldPlane {
  core::Vec3 normal;  ///< unit, out of the part
  double offset;      ///< normal . x on the plane, mm
};

/// As Trim: where a function of the place is above zero, in world coordinates.
struct PartTrim {
  std::optional<mesh::SupportSurface> surface;  ///< nothing: the plane
  WorldPlane plane;
  bool above = false;
};

/// As TrimmedFace: a face of a part that is not convex.
struct PartFace {
  std::uint32_t plane = kNoSurface, quadric = kNoSurface;  ///< one of them, of the part's
  bool wall = false;                                       ///< the part is outside of the quadric
  std::vector<PartTrim> trims;
  std::vector<std::uint64_t> cells;  ///< empty: one
  std::vector<core::Vec3> corners;   ///< of its triangles
  double bulge_mm = 0.0;             ///< by which it may extend beyond the box around these
};

/// A part with exact faces (world, mm).
struct PartBody {
  bool convex = false;                         ///< it is the intersection of the insides of its surfaces
  bool round = false;                          ///< it has round faces, which are exact
  std::string facets_because;                  ///< reason why its known round faces stay facets
  std::vector<WorldPlane> planes;              ///< where exact
  std::vector<mesh::SupportSurface> quadrics;  ///< as PlacedPart::supports
  std::vector<PartFace> faces;                 ///< where exact and not convex
  std::vector<core::Vec3> corners;             ///< of its own triangles
  double deviation_mm = 0.0;                   ///< largest of its facets from their surfaces
  double off_surface_mm = 0.0;                 ///< largest distance of what touches it from its surfaces

  bool is_exact() const { return convex || !faces.empty(); }
  /// Leaves facets, for a reason.
  void leave_facets(const std::string& reason) {
    round = convex = false;
    faces.clear();
    facets_because = reason;
  }
};
using PartBodies = core::IdVector<core::PartId, PartBody>;

/// The bodies of all parts; empty where no part has round faces whose surface is known.
///
/// A part whose faces lie on planes and on the outer side of convex quadrics, and on the inner side of none
/// of these, is the intersection of their insides: its boundary is part of the intersection's, and that is
/// connected. Corners are compared with every surface. Any other part is what its trimmed faces enclose.
/// Round faces that touch another part have to be one surface with the other's face there; else both parts
/// keep their facets.
PartBodies find_part_bodies(const Assembly& assembly,
                            const std::vector<contact::InterfaceTriangle>& triangles);

/// Whether the round faces of two parts are exact, so that find_part_bodies has compared the exact bodies,
/// and none of one is the same surface as one of the other, which their facets would have to share.
bool fit_exactly(const Assembly& assembly, const PartBodies& bodies, core::PartId a, core::PartId b);

/// Finds the trimmed faces of a part that is not convex, whose planes and quadrics are known.
///
/// Triangles of one surface are one face. Where it borders on another, that surface, or a plane or cylinder
/// through their common edge, is a function whose sign changes there; the signs at points of the face's
/// triangles are its cells. Points of the surface beyond the face, and rays across the part, are compared
/// with the triangles.
/// @return the reason why they are not found; empty where they are
std::string find_trimmed_faces(const contact::PlacedPart& part, double tolerance_mm, PartBody& body);

/// A region's frame: world = centre + rotation * local.
struct RegionFrame {
  core::Vec3 centre;
  Eigen::Matrix3d rotation;

  core::Vec3 point(const core::Vec3& world) const { return rotation.transpose() * (world - centre); }
  core::Vec3 direction(const core::Vec3& world) const { return rotation.transpose() * world; }
  mesh::SupportSurface surface(mesh::SupportSurface world) const {
    world.origin = point(world.origin);
    world.axis = direction(world.axis);
    return world;
  }
};

/// Adds a trimmed face of a part whose planes and quadrics begin where those of `body` do. Returns its
/// number.
std::uint32_t add_trimmed_face(const PartFace& face, const RegionFrame& frame, const ExactBody& body,
                               ExactBodies& exact);

/// Adds the trimmed faces of a part to a body whose planes and quadrics are those of the part, in order.
void add_trimmed_faces(const PartBody& part, const RegionFrame& frame, ExactBody& body, ExactBodies& exact);

/// The part by itself, as the body that holds a region, in world coordinates.
ExactBodies part_alone(const PartBody& part);

/// A triangle of a region's boundary, and the parts at it.
struct RegionTriangle {
  BoundaryTriangle local;                    ///< in the region's frame
  std::uint32_t label = 0;                   ///< of what it leads to
  core::PartId body, other;                  ///< the part whose face it is, and that on the other side of it
  std::uint32_t support = mesh::kNoSupport;  ///< in the part's list
};

/// Whether a triangle of the region of `of` is on an exact body, once the region has any.
bool on_exact_body(const PartBodies& bodies, core::PartId of, core::PartId body);

/// Whether the region needs exact bodies: one is round, or the end of a round one covers part of a plane of
/// it.
bool needs_exact_bodies(const PartBodies& bodies, core::PartId of,
                        const std::vector<RegionTriangle>& triangles);

/// The exact bodies of the region of `of`.
/// @param triangles  those that are on none of the bodies first
ExactBodies exact_bodies_of(const PartBodies& bodies, core::PartId of, const RegionFrame& frame,
                            const std::vector<RegionTriangle>& triangles);

/// A triangle and the number of the surface that it approximates, or mesh::kNoSupport.
struct SurfaceTriangle {
  Corners corners;
  std::uint32_t support = mesh::kNoSupport;
};

/// Area and volume that the true edges between exact faces add to triangles with their patches
/// (mesh::patch_excess), by triangle and side: a flat face extends from the chord to the curve, and the patch
/// of a round one ends there. Exact to rounding for circles of cylinders, cones and tori; for other curves
/// the error goes with the fourth power of the facets' angle.
/// @param triangles  of a closed boundary, outwards
std::vector<std::array<mesh::PatchExcess, 3>> edge_excess(const std::vector<SurfaceTriangle>& triangles,
                                                          const std::vector<mesh::SupportSurface>& supports);

/// The box around the exact faces of a closed boundary, to 1e-9 of its size.
Eigen::AlignedBox3d exact_bounds(const std::vector<SurfaceTriangle>& triangles,
                                 const std::vector<mesh::SupportSurface>& supports);

/// Sets scene.parts and scene.faces, as their triangles are.
void describe_parts(const Assembly& assembly, Scene& scene);

/// Adds to the description what is known of round faces, and to areas and volumes what the exact ones enclose
/// beyond their triangles; `interface_of[i]` is the interface of triangles[i].
void describe_curves(const Assembly& assembly, const PartBodies& bodies,
                     const std::vector<contact::InterfaceTriangle>& triangles,
                     const std::vector<core::InterfaceId>& interface_of, Scene& scene);

/// Sets scene.regions from interface triangles; `interface_of[i]` is the interface of triangles[i]. Regions
/// whose boundaries are equal in their parts' own frames, and lead to the same pattern of interfaces, share
/// one accelerator.
/// @param bodies  of the parts; empty: none is exact
void build_regions(const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles,
                   const std::vector<core::InterfaceId>& interface_of, const PartBodies& bodies,
                   Scene& scene);

}  // namespace scintray::scene
