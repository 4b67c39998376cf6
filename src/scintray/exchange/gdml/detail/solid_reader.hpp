#pragma once
/// The numbers of one solid of a GDML file.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::exchange::gdml {

/// Base of the readers of solids. Lengths in mm, angles in rad, converted from the solid's own units.
class SolidReader {
 public:
  SolidReader(Node solid, const Definitions& definitions, const mesh::Tessellation& tessellation)
      : solid_(solid), definitions_(definitions), tessellation_(tessellation) {}

 protected:
  double length(const char* attribute, double fallback = 0.0) const {
    return definitions_.length(solid_, attribute, fallback);
  }
  /// A length that must be present and above 0.
  double size(const char* attribute) const {
    const double value = length(attribute);
    if (!(value > 0.0)) mesh::reject_shape(std::string("\"") + attribute + "\" is missing or not above 0");
    return value;
  }
  double angle(const char* attribute, double fallback = 0.0) const {
    return definitions_.angle(solid_, attribute, fallback);
  }
  double unit() const { return definitions_.number(solid_, "lunit", 1.0); }

  /// Flat sides of an arc of a wall about the axis: the fewest of an arc, doubled until they satisfy the
  /// tessellation, so that walls of nearly equal radii keep the same corners.
  int segments_about(double radius_mm, double arc_rad, int least) const {
    const int needed = mesh::arc_segments(radius_mm, arc_rad, tessellation_, 1);
    int segments = mesh::arc_segments(0.0, arc_rad, tessellation_, least);
    while (segments < needed) segments *= 2;
    return segments;
  }

  /// Facets with corners in either sense of rotation, welded and oriented outwards.
  static mesh::TriMesh from_facets(const std::vector<std::vector<core::Vec3>>& facets);

  /// The solid, from the member function with its element's name; empty when there is none.
  template <typename Maker, typename Kinds>
  static std::optional<mesh::TriMesh> make_one_of(const Maker& maker, const Kinds& kinds) {
    for (const auto& kind : kinds)
      if (kind.name == maker.solid_.name()) return (maker.*kind.make)();
    return std::nullopt;
  }

  Node solid_;
  const Definitions& definitions_;
  const mesh::Tessellation& tessellation_;
};

/// The shape of a scene file that has the faces of a solid exactly, in its frame, as a line of a [[part]]: of
/// a full torus, an uncut or cut ellipsoid of revolution, a paraboloid and a full hyperboloid, whose faces
/// are not recognized in triangles; empty for other solids.
/// @pre the dimensions are valid: its mesh could be made
std::optional<std::string> exact_shape(Node solid, const Definitions& definitions,
                                       const mesh::Tessellation& tessellation);

/// Mesh of a solid of flat faces or ruled walls, by the name of its element; empty for other solids.
/// Throws InputError for impossible dimensions.
std::optional<mesh::TriMesh> make_flat_solid(Node solid, const Definitions& definitions,
                                             const mesh::Tessellation& tessellation);

/// The same for solids of revolution and those with curved walls.
std::optional<mesh::TriMesh> make_round_solid(Node solid, const Definitions& definitions,
                                              const mesh::Tessellation& tessellation);

/// The same for twisted solids.
std::optional<mesh::TriMesh> make_twisted_solid(Node solid, const Definitions& definitions,
                                                const mesh::Tessellation& tessellation);

}  // namespace scintray::exchange::gdml
