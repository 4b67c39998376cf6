#pragma once
/// Closed bodies of detectors: prisms, chamfered blocks, tapers, Winston cones. Oriented outwards, lengths
/// in mm, each standing on z = 0 about the z axis unless stated otherwise.

#include <array>

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
