#pragma once
/// Closed bodies of detectors: prisms, chamfered and rounded blocks, tapers, lenses, concentrators, fibres.
/// Oriented outwards, lengths in mm, each standing on z = 0 about the z axis unless stated otherwise.

#include <array>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Prism over a regular polygon, first corner on +x. Groups "side0", "side1"... ("side0" between the first
/// corner and the next counter-clockwise), "-z", "+z", and "chamfer" where there is one.
///
/// @param circumradius  of the circle through the corners; the flats are 2 R cos(pi / sides) apart
/// @param chamfer       width of the bevel as measured along each of the two faces of an edge
/// @throws InputError for fewer than 3 sides, lengths that are not positive, or a chamfer that leaves
///         nothing of a face.
TriMesh make_prism(int sides, double circumradius, double height, double chamfer = 0.0);

/// Box whose 12 edges are bevelled by planes: 6 rectangles with the groups of make_box, and 12 bevels and 8
/// corner triangles in the group "chamfer". `chamfer` is the width removed from each face along an edge.
/// @throws InputError as make_box, and when the chamfer is not positive or leaves nothing of a face.
TriMesh make_chamfered_box(const core::Vec3& low, const core::Vec3& high, double chamfer);

/// An axis-aligned rectangle in a plane of constant z.
struct Rectangle {
  std::array<double, 2> size{};    ///< along x, y
  std::array<double, 2> centre{};  ///< x, y
  bool operator==(const Rectangle&) const = default;
};

/// Frustum between a rectangle at z = 0 and one at `height`, also oblique. Groups as of make_box.
/// Sides whose edges at both ends are parallel are flat; they always are, since both are axis-aligned.
/// @throws InputError for sizes or a height that are not positive.
TriMesh make_tapered(const Rectangle& bottom, const Rectangle& top, double height);

/// A lens about the z axis, its lower vertex at the origin.
struct LensShape {
  double diameter = 0.0;
  double thickness = 0.0;  ///< between the vertices, on the axis
  /// Radii of curvature of the lower and the upper face: above 0 convex, below 0 concave, 0 flat.
  double bottom_radius = 0.0, top_radius = 0.0;
  double bottom_conic = 0.0, top_conic = 0.0;  ///< conic constants; 0: a sphere, -1: a paraboloid
  std::vector<double> bottom_aspheric = {},
                      top_aspheric = {};  ///< terms of the depth in h^4, h^6 ..., mm^-3, mm^-5
  int segments = 64;                      ///< flat sides of a full circle, about the axis and along the faces
  bool operator==(const LensShape&) const = default;
};

/// Depth of a lens face at the distance h from its axis, with c = 1 / R, conic constant k and terms a:
/// c h^2 / (1 + sqrt(1 - (1 + k) c^2 h^2)) + a[0] h^4 + a[1] h^6 + ...; 0 for R = 0, a flat face.
/// (1 + k) h^2 is not above R^2.
double sagitta(double radius, double height, double conic = 0.0, const std::vector<double>& aspheric = {});

/// The lens, corners on its true faces, with their spheres or conics and the cylinder of its edge as support
/// surfaces; of a face with aspheric terms quadrics between its rings. Groups "-z" (lower face), "+z", and
/// "side" where there is an edge.
/// @throws InputError for lengths that are not positive, radii of less than half the diameter, faces that end
///         before the edge or turn back, an edge of negative height, faces that cross, or fewer than 3
///         segments.
TriMesh make_lens(const LensShape& shape);

/// The body between the z axis and a profile: straight lines from corner to corner of (r, z). A corner with
/// r = 0 is on the axis; the profile begins and ends there, or is closed. Walls are cylinders and cones, and
/// have them as support surfaces; walls perpendicular to the axis are flat. Groups "side0", "side1"... by the
/// side from the corner of this number to the next.
/// @param smooth  first and last corners of ranges in which a smooth curve leads through the corners: two
///                quadrics of revolution with a common tangent between each corner and the next; the group
///                is that of the first
/// @throws InputError for fewer than 2 corners off the axis, negative radii, a profile that crosses itself,
///         a smooth range that turns back along z, or fewer than 3 segments.
TriMesh make_revolved(const std::vector<std::array<double, 2>>& profile, int segments,
                      const std::vector<std::array<std::size_t, 2>>& smooth = {});

/// A cylinder with a bore, from z = 0 up.
struct TubeShape {
  double outer_radius = 0.0, inner_radius = 0.0, height = 0.0;
  int segments = 64;
  bool operator==(const TubeShape&) const = default;
};

/// The tube, with its cylinders as support surfaces. Groups "-z", "side", "+z", "bore".
/// @throws InputError for lengths that are not positive, a bore as wide as the tube, fewer than 3 segments.
TriMesh make_tube(const TubeShape& shape);

/// A torus about the z axis and the origin.
struct TorusShape {
  double radius = 0.0;  ///< of the circle in the middle of the tube
  double tube_radius = 0.0;
  int segments = 64, tube_segments = 32;
  bool operator==(const TorusShape&) const = default;
};

/// The torus, which is its support surface. One group, "torus".
/// @throws InputError for a tube_radius that is not positive, or not below radius, fewer than 3 segments.
TriMesh make_torus(const TorusShape& shape);

/// Ellipsoid of revolution about the z axis, centred at the origin: a geodesic sphere, stretched. One group,
/// "spheroid", with the spheroid as support surface.
/// @param radius       perpendicular to the axis
/// @param half_height  along it
/// @throws InputError for lengths that are not positive, or subdivisions < 1.
TriMesh make_spheroid(double radius, double half_height, int subdivisions);

/// Box whose edges and corners are rounded: 6 rectangles with the groups of make_box, and cylinders and
/// spheres, their support surfaces, in the group "rounding".
/// @param segments  flat sides of a full circle; a quarter has at least one
/// @throws InputError as make_box, and when the radius is not positive or leaves nothing of a face.
TriMesh make_rounded_box(const core::Vec3& low, const core::Vec3& high, double radius, int segments);

/// A round or square rod along a path of straight lines, bent at its corners along arcs.
struct FibreShape {
  std::vector<core::Vec3> path = {};  ///< 2 points or more, mm
  double bend_radius = 0.0;  ///< of the arcs, in the middle of the rod; for a path of 3 points or more
  double radius = 0.0;       ///< of a round one; 0: square
  double side = 0.0;         ///< of a square one, whose path lies in a plane
  int segments = 64;         ///< flat sides of a full circle, about the rod and along the arcs
  bool operator==(const FibreShape&) const = default;
};

/// The rod, with its cylinders and tori as support surfaces. Groups "side" (round) or "side0" to "side3"
/// (square; "side0" and "side2" are those that bend with the path), "start" and "end".
/// @throws InputError for lengths that are not positive, points that coincide, arcs that do not fit between
///         them, bends tighter than the rod allows, a path that turns back, or a square rod whose path is in
///         no plane.
TriMesh make_fibre(const FibreShape& shape);

/// A compound parabolic concentrator: its exit stands on z = 0, its entrance faces +z.
struct WinstonShape {
  double exit_radius = 0.0;     ///< half the width of a trough's exit
  double acceptance_rad = 0.0;  ///< largest angle to the axis that is concentrated, 0 to pi / 2
  double length = 0.0;          ///< shorter than full truncates the entrance; 0 is the full length
  double trough_width = 0.0;    ///< above 0: a two-dimensional trough of this width along y
  int segments = 64;            ///< flat sides about the axis of a cone
  int rings = 32;               ///< straight segments of the profile
  bool operator==(const WinstonShape&) const = default;
};

/// Full length of a concentrator, (a + a') cot(theta) with a = a' / sin(theta), a' the exit's radius.
/// Source: W. T. Welford and R. Winston, High Collection Nonimaging Optics (1989), section 4.3.
double winston_length(double exit_radius, double acceptance_rad);

/// Radius of the profile at height z above the exit, by bisection of the parametric form
/// r = 2 f sin(phi - theta) / (1 - cos phi) - a', z = 2 f cos(phi - theta) / (1 - cos phi),
/// f = a' (1 + sin theta). Source: Welford and Winston 1989, section 4.3.
/// @param z  from 0 to the full length
double winston_radius(double exit_radius, double acceptance_rad, double z);

/// The body inside the concentrator, corners of every ring on the true profile. Rings follow equal steps of
/// the profile's parameter; a cone has a further ring halfway between each two. Its support surfaces are
/// quadrics of revolution between the rings, with common tangents, which have the true radii and tangents at
/// those on the profile. Groups "side", "-z" (exit), "+z" (entrance); a trough's are those of make_box.
/// @throws InputError for lengths that are not positive, an angle outside 0 to 90 deg, a length beyond the
///         full one, or fewer than 3 segments or 1 ring.
TriMesh make_winston(const WinstonShape& shape);

}  // namespace scintray::mesh
