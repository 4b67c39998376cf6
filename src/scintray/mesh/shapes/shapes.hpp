#pragma once
/// Closed bodies of detectors: prisms, chamfered blocks, tapers, Winston cones. Oriented outwards, lengths
/// in mm, each standing on z = 0 about the z axis unless stated otherwise.

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
/// corner triangles in the group "chamfer". `chamfer` is the width taken off each face along an edge.
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
  int segments = 64;  ///< flat sides of a full circle, about the axis and along the faces
  bool operator==(const LensShape&) const = default;
};

/// Depth of a spherical face at the distance `height` from its axis, R - sqrt(R^2 - h^2), with the sign of R;
/// 0 for R = 0, a flat face. |R| is not below the height.
double sagitta(double radius, double height);

/// The lens, corners on its true faces, with their spheres and the cylinder of its edge as support surfaces.
/// Groups "-z" (lower face), "+z", and "side" where there is an edge.
/// @throws InputError for lengths that are not positive, radii of less than half the diameter, an edge of
///         negative height, faces that cross, or fewer than 3 segments.
TriMesh make_lens(const LensShape& shape);

/// The body between the z axis and a profile: straight lines from corner to corner of (r, z). A corner with
/// r = 0 is on the axis; the profile begins and ends there, or is closed. Walls are cylinders and cones, and
/// have them as support surfaces; walls across the axis are flat. Groups "side0", "side1"... by the side from
/// the corner of this number to the next.
/// @throws InputError for fewer than 2 corners off the axis, negative radii, a profile that crosses itself,
///         or fewer than 3 segments.
TriMesh make_revolved(const std::vector<std::array<double, 2>>& profile, int segments);

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

/// The body inside the concentrator, corners of every ring on the true profile. Rings follow even steps of
/// the profile's parameter. Groups "side", "-z" (exit), "+z" (entrance); a trough's are those of make_box.
/// @throws InputError for lengths that are not positive, an angle outside 0 to 90 deg, a length beyond the
///         full one, or fewer than 3 segments or 1 ring.
TriMesh make_winston(const WinstonShape& shape);

}  // namespace scintray::mesh
