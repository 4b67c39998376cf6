#pragma once
/// Triangle meshes of parts.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray {

/// A triangle mesh, mm, triangles counter-clockwise seen from outside.
struct TriMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Per triangle, index into `groups`: the glTF material or OBJ group it came with.
  std::vector<std::uint32_t> group;
  std::vector<std::string> groups;

  Vec3 area_vector(std::size_t triangle) const;  ///< normal times area, mm2
  double area() const;                           ///< mm2
  double volume() const;                         ///< mm3, positive when oriented outwards
};

/// Middle of a triangle, mm.
Vec3 centre_of(const TriMesh& mesh, std::size_t triangle);

/// Takes out the triangles, with their groups, where `wanted` is zero; the rest keep their order.
void keep_triangles(TriMesh& mesh, const std::vector<char>& wanted);

}  // namespace scintray
