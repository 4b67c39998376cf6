#pragma once
/// Triangle meshes of parts.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scintray/core/vec.hpp"
#include "scintray/mesh/support_surface.hpp"

namespace scintray::mesh {

/// Keys and values that a file assigns to some of its triangles: glTF extras, the colour of a CAD face.
using FaceTags = std::map<std::string, std::string>;

/// A number as the value of a tag: shortest form that reads back as the same number.
std::string tag_text(double number);

/// A triangle mesh, mm, triangles counter-clockwise seen from outside.
struct TriMesh {
  std::vector<core::Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Per triangle, index into `groups`: its glTF material or OBJ group.
  std::vector<std::uint32_t> group;
  std::vector<std::string> groups;
  /// Per group, the tags of the file beside its name; empty when no group has any. Groups that differ only
  /// here have the same name.
  std::vector<FaceTags> group_tags;
  /// Surfaces that round faces approximate, and per triangle the index of its own there, or kNoSupport. Both
  /// empty: none has any. An operation that cannot keep them leaves both empty.
  std::vector<SupportSurface> supports;
  std::vector<std::uint32_t> support;

  core::Vec3 area_vector(std::size_t triangle) const;  ///< normal times area, mm2
  double area() const;                                 ///< mm2
  double volume() const;                               ///< mm3, positive when oriented outwards

  /// Tags of a group; empty when the file has none.
  const FaceTags& tags_of(std::size_t group_number) const;
  /// Number of the group with this name and these tags, added when it is new.
  std::uint32_t group_index(const std::string& name, const FaceTags& tags = {});

  /// Number of a triangle's support surface; kNoSupport: none.
  std::uint32_t support_of(std::size_t triangle) const {
    return triangle < support.size() ? support[triangle] : kNoSupport;
  }
  /// Number of a surface, which is added unless one that is equal to rounding exists.
  std::uint32_t support_index(const SupportSurface& surface);
  /// Adds a surface and makes it the support surface of the triangles from `first` to `last` - 1.
  void set_support(const SupportSurface& surface, std::size_t first, std::size_t last);
};

/// Centroid of a triangle, mm.
core::Vec3 centre_of(const TriMesh& mesh, std::size_t triangle);

/// Removes the triangles, with their groups and supports, where `wanted` is zero; the rest keep their order.
void keep_triangles(TriMesh& mesh, const std::vector<char>& wanted);

/// Adds `by` (mm) to every position.
void translate(TriMesh& mesh, const core::Vec3& by);

}  // namespace scintray::mesh
