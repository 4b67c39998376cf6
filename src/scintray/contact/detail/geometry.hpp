#pragma once
/// Geometry for resolving contacts: a part with a tree over its triangles.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/contact/box_tree.hpp"
#include "scintray/contact/contacts.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::contact {

using Vec2 = Eigen::Vector2d;
using Triangle = std::array<std::uint32_t, 3>;

/// Rotation into axes along the largest faces of all parts, in which boxes enclose arrays of crystals
/// closely for any orientation of the assembly. Identity for an upright assembly.
Eigen::Matrix3d natural_axes(const std::vector<PlacedPart>& parts);

/// Position of a point relative to a body.
enum class Side { inside, outside, on_surface };

/// A part with the data of its queries. Boxes are in the axes given on construction.
class Body {
 public:
  Body(const PlacedPart& part, const Eigen::Matrix3d& axes);

  /// Recomputes all that depends on the vertices after they have moved.
  void update();

  Box box_of(std::uint32_t triangle) const;
  Box box_of(const core::Vec3& a, const core::Vec3& b) const;
  const core::Vec3& corner(std::uint32_t triangle, int k) const { return vertices[triangles[triangle][k]]; }
  /// Number of a triangle's support surface; mesh::kNoSupport: none.
  std::uint32_t support_of(std::uint32_t triangle) const {
    return support.empty() ? mesh::kNoSupport : support[triangle];
  }
  /// Normal times area, mm2.
  core::Vec3 area_vector(std::uint32_t triangle) const;

  /// Side of `point`; on_surface when it is within `margin_mm` of a triangle.
  Side side_of(const core::Vec3& point, double margin_mm) const;
  /// A point well inside: the middle of the longest chord among those that start perpendicularly at
  /// the largest triangles.
  core::Vec3 interior_point() const;

  std::vector<core::Vec3> vertices;  ///< equal positions are one vertex
  std::vector<Triangle> triangles;
  std::vector<core::FaceId> face;
  std::vector<std::uint32_t> support;  ///< as PlacedPart::support
  std::vector<core::Vec3> normal;      ///< unit; zero for a triangle without area
  double area = 0.0;                   ///< mm2
  double volume = 0.0;                 ///< mm3
  Box box;
  BoxTree tree;                       ///< of the triangles
  std::vector<std::uint32_t> shells;  ///< a vertex of each connected piece of the surface

 private:
  void find_shells();
  bool encloses(const core::Vec3& point) const;
  Eigen::Matrix3d axes_;
};

}  // namespace scintray::contact
