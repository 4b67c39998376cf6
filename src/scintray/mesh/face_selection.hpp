#pragma once
/// Selection of triangles of a mesh, to assign a surface to them.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Angle between the normals of neighbouring triangles beyond which their edge ends a smooth region (chosen).
inline constexpr double kSmoothEdge = 30.0 * core::kDegree;

/// Conditions on a triangle; all that are set must hold, and without conditions every triangle is selected.
/// Lengths in mm, in the coordinates of the mesh.
struct FaceSelector {
  /// Outward normal within normal_tolerance_rad of this direction (need not have unit length).
  std::optional<core::Vec3> normal;
  double normal_tolerance_rad = 1.0 * core::kDegree;
  /// All three vertices inside, the border and single-precision rounding (rounding_length) included.
  std::optional<Eigen::AlignedBox3d> box;
  /// In the flat region around the triangle nearest this point.
  std::optional<core::Vec3> flat_region;
  double flat_tolerance_rad = 0.1 * core::kDegree;
  /// In the smooth region (smooth_regions) of the triangle nearest this point.
  std::optional<core::Vec3> smooth_region;
  /// In a smooth region that has triangles of this group, named as in `group`.
  std::optional<std::string> smooth_around;
  double edge_angle_rad = kSmoothEdge;
  /// Group name: glTF material, OBJ group or material, side of a primitive. For a group named
  /// "object:material" either half alone matches too; the number of a CAD face ("face12") matches whatever
  /// the name of the face.
  std::optional<std::string> group;
  /// Tags of the group that must have these values: glTF extras, "color" of a CAD face.
  FaceTags tags;
  /// The one triangle nearest this point (the lowest index among equally near ones).
  std::optional<core::Vec3> nearest;
};

/// Mask over triangles: 1 where every condition holds. A triangle without area matches no normal.
/// @throws InputError for a normal of length zero or a negative tolerance.
std::vector<char> select_triangles(const TriMesh& mesh, const FaceSelector& selector);

/// Label per triangle, 0, 1, ... in order of first triangle. A region grows through shared edges from
/// its first triangle over neighbours whose normal is within the tolerance of that first triangle's,
/// or that lie in its plane within single-precision rounding; it does not extend around a cylinder.
std::vector<std::uint32_t> flat_regions(const TriMesh& mesh, double angle_tolerance_rad);

/// Label per triangle, 0, 1, ... in order of first triangle. Neighbours whose normals differ by at most
/// `edge_angle_rad` at their edge are of one region, which so extends around cylinders and fillets. With
/// `by_group` a region also ends where the group does.
/// @throws InputError for a negative angle
std::vector<std::uint32_t> smooth_regions(const TriMesh& mesh, double edge_angle_rad, bool by_group = false);

/// `mask` extended to every triangle whose label a selected triangle has.
std::vector<char> whole_regions(const std::vector<char>& mask, const std::vector<std::uint32_t>& labels);

/// Index of the triangle nearest `point`, lowest index among equals. @throws InputError when empty.
std::size_t nearest_triangle(const TriMesh& mesh, const core::Vec3& point);

}  // namespace scintray::mesh
