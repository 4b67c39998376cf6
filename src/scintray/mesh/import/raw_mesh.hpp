#pragma once
/// Result of the reader of a mesh format.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// The unit of length of a mesh file.
struct FileUnit {
  std::string name;      ///< such as "inch"; empty when neither the file nor its format states one
  double mm = 0.0;       ///< length of the unit; 0 when unknown
  bool written = false;  ///< the file itself states it; otherwise its format prescribes it
  double read_mm = 0.0;  ///< length of one unit of the coordinates, as the library returned them
};

/// Triangles of the file, in file units; vertices not welded, indices checked.
struct RawMesh {
  TriMesh mesh;
  FileUnit unit;
  std::vector<std::string> notes;

  /// Objects, nodes or solids of the file, names unique, and for each triangle which it belongs to. A
  /// format without such a structure leaves both empty.
  std::vector<std::string> bodies;
  std::vector<std::uint32_t> body_of;

  std::size_t points_and_lines = 0;   ///< faces with fewer than three corners, left out
  std::size_t crossing_polygons = 0;  ///< polygons that cross themselves, triangulated approximately
  double deviation_mm = 0.0;          ///< largest distance found between triangles and a curved CAD face

  /// Begins a body: triangles added from now on, and those without one, belong to it. A number is appended
  /// to a name that is taken; an empty one becomes "body".
  void begin_body(const std::string& name);
  /// Assigns the triangles added since the last call to the latest body.
  void fill_body();

  /// Adds a polygon over vertices of `mesh`, cut in triangles, with its corners in reverse order when
  /// `mirrored`. Returns false when it has more than kMostCorners corners.
  [[nodiscard]] bool add_polygon(const std::vector<std::uint32_t>& corners, std::uint32_t group,
                                 bool mirrored);
};

/// A name of a file as text that can be shown, written to other files and typed again: bytes that are not
/// UTF-8 are taken as Latin-1, and control characters become "_".
std::string plain_name(std::string_view name);

/// The group of triangles of an object in a material: "object:material", the one of them that has a name, or
/// "default".
std::string group_name(const std::string& object, const std::string& material);

/// Largest number of vertices or triangles of one mesh; their indices are 32 bits wide.
inline constexpr std::size_t kMostElements = 0x7FFFFFFF;

}  // namespace scintray::mesh
