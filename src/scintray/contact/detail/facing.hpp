#pragma once
/// Faces of two parts, flat or curved, that lie near each other and face each other.

#include <vector>

#include "scintray/contact/detail/geometry.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::contact {

/// Contact of a triangle of one part with the other part.
enum class Facing {
  none,     ///< none within the tolerance
  flat,     ///< wherever it is in contact, within the scene's own tolerance
  partly,   ///< only partly within the tolerance
  covered,  ///< entirely within it
};

/// Points of a triangle: a regular grid of 6 steps a side, its corners included.
std::vector<core::Vec3> samples_of(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c);
std::vector<core::Vec3> samples_of(const Body& body, std::uint32_t triangle);

/// The triangle of `body` nearest to a point, among those within `reach` whose normal is within 45 deg of
/// `normal`, or, when `opposed`, of its opposite.
struct Nearest {
  std::uint32_t triangle = ~0U;
  double distance = HUGE_VAL;
  bool found() const { return triangle != ~0U; }
};
/// @param only  per triangle, whether it counts; null: all do
Nearest nearest(const Body& body, const core::Vec3& point, const core::Vec3& normal, bool opposed,
                double reach, const std::vector<char>* only = nullptr);

/// Which triangles of two bodies can be in contact, per triangle; empty: all.
struct Contactable {
  std::vector<char> of_body, of_other;
};

/// How near faces in contact are, mm.
struct ContactReach {
  double tolerance;  ///< of the contact
  double flat;       ///< of the scene: faces within this are in contact already
};

/// Contact of each triangle of `body` with `other`.
std::vector<Facing> facing(const Body& body, const Body& other, const ContactReach& reach,
                           const Contactable& only = {});

/// Moves vertices of `mesh`, whose geometry `body` is, so that the planes of marked triangles move outwards
/// by `by` and those of their neighbours do not move (least squares, weighted by area so that slivers, whose
/// normals are rounding, do not count; nearly parallel planes count as one).
mesh::TriMesh pushed(mesh::TriMesh mesh, const Body& body, const std::vector<char>& marked, double by);

}  // namespace scintray::contact
