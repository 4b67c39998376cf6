#pragma once
/// What the reader of a mesh format returns.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// The unit of length of a mesh file.
struct FileUnit {
  std::string name;      ///< as "inch"; empty when neither the file nor its format states
  double mm = 0.0;       ///< length of the unit; 0 when unknown
  bool written = false;  ///< the file itself states it; otherwise its format prescribes it
  double read_mm = 0.0;  ///< what one unit of the coordinates, as the library gave them, is
};

/// Triangles as the file has them, in file units; vertices not welded, indices checked.
struct RawMesh {
  TriMesh mesh;
  FileUnit unit;
  std::vector<std::string> notes;

  /// Objects, nodes or solids of the file, names unique, and for each triangle which it belongs to. A
  /// format without such a structure leaves both empty.
  std::vector<std::string> bodies;
  std::vector<std::uint32_t> body_of;

  std::size_t points_and_lines = 0;   ///< faces with fewer than three corners, left out
  std::size_t crossing_polygons = 0;  ///< polygons that cross themselves, cut as well as may be
  double deviation_mm = 0.0;          ///< largest distance found between triangles and a curved CAD face

  /// Begins a body: triangles added from now on, and those left without one, belong to it. A name that is
  /// taken gets a number; an empty one becomes "body".
  void begin_body(const std::string& name);
  /// Gives the triangles added since the last call to the latest body.
  void fill_body();

  /// Adds a polygon over vertices of `mesh`, cut in triangles, with its corners in reverse order when
  /// `mirrored`. Returns false when it has more than kMostCorners corners.
  [[nodiscard]] bool add_polygon(const std::vector<std::uint32_t>& corners, std::uint32_t group,
                                 bool mirrored);
};

/// The group of triangles of an object in a material: "object:material", the one of them that has a name, or
/// "default".
std::string group_name(const std::string& object, const std::string& material);

/// Largest number of vertices or triangles of one mesh; their indices are 32 bits wide.
inline constexpr std::size_t kMostElements = 0x7FFFFFFF;

}  // namespace scintray::mesh
