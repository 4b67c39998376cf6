#pragma once
/// Simple closed bodies, oriented outwards, and operations on whole meshes. Lengths in mm.

#include <Eigen/Geometry>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Box of 12 triangles, two per side in the order of its groups "-x", "+x", "-y", "+y", "-z", "+z".
/// @throws InputError when a side is not positive or not finite.
TriMesh make_box(const core::Vec3& low, const core::Vec3& high);

/// Relation of a cylinder's polygon to its circle.
enum class CylinderRadius {
  inscribed_polygon,  ///< corners on the circle: the polygon is inside the cylinder
  equal_area,         ///< same cross-section, and so the same volume, as the true cylinder
};

/// Height of the flattest triangle of an end of many corners, over the size of the body, below which the end
/// has a vertex at its centre: forty times the limit of degenerate triangles (2^-22 of the largest
/// coordinate).
inline constexpr double kFlatCap = 1e-5;

/// Regular prism that represents a cylinder about the z axis, z from 0 to height, first corner on +x.
/// Groups "side" (2 triangles a segment), "-z", "+z" (fans; about a vertex in the middle where kFlatCap
/// requires it). The side of an inscribed polygon carries the cylinder as its support surface.
/// @throws InputError when radius or height is not positive, or segments < 3.
TriMesh make_cylinder(double radius, double height, int segments,
                      CylinderRadius kind = CylinderRadius::inscribed_polygon);

/// Frustum of a cone about the z axis, z from 0 to height; one of the radii may be 0, which makes a tip.
/// Groups "side" and, where there is an end, "-z", "+z". The side carries the cone, or the cylinder for equal
/// radii, as its support surface.
/// @throws InputError when the height is not positive, a radius is negative, both are 0, or segments < 3.
TriMesh make_cone(double bottom_radius, double top_radius, double height, int segments);

/// Geodesic sphere about the origin: an icosahedron whose triangles are each cut into subdivisions^2,
/// all vertices on the sphere, which is their support surface; 20 subdivisions^2 triangles, one group
/// "sphere".
/// @throws InputError when radius is not positive, or subdivisions < 1.
TriMesh make_sphere(double radius, int subdivisions);

/// Mesh with every triangle cut into n*n similar ones; shared edges remain shared. Triangle t becomes
/// triangles n*n*t ... n*n*(t+1)-1, without support surfaces. @throws InputError for n < 1.
TriMesh subdivide_faces(const TriMesh& mesh, int n);

/// Mesh transformed by `transform`; triangles are reversed when it mirrors (determinant < 0), so that outward
/// remains outward. Support surfaces move along, unless angles change, which leaves facets. @throws
/// InputError when the determinant is zero or not finite.
TriMesh transformed(const TriMesh& mesh, const Eigen::Affine3d& transform);

/// Reverses every triangle, in place.
void reverse_orientation(TriMesh& mesh);

/// Both meshes in one; vertices are not welded, groups with the same name and tags become one.
TriMesh joined(const TriMesh& a, const TriMesh& b);

}  // namespace scintray::mesh
