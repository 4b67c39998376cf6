#pragma once
/// What a file format's reader hands over.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray {

/// Triangles as the file has them, in file units; vertices not welded, indices checked.
struct RawMesh {
  TriMesh mesh;
  std::string unit_from_file;
  std::vector<std::string> notes;

  std::size_t points_and_lines = 0;   ///< faces with fewer than three corners, left out
  std::size_t crossing_polygons = 0;  ///< polygons that cross themselves, cut as well as may be

  /// Adds a polygon over vertices of `mesh`, cut in triangles, with its corners in reverse order when
  /// `mirrored`. Returns false when it has more than kMostCorners corners.
  bool add_polygon(const std::vector<std::uint32_t>& corners, std::uint32_t group, bool mirrored);

  /// Index of the group, added when it is new.
  std::uint32_t group_index(const std::string& name) {
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), name);
    const auto index = static_cast<std::uint32_t>(found - mesh.groups.begin());
    if (found == mesh.groups.end()) mesh.groups.push_back(name);
    return index;
  }
};

/// Largest number of vertices or triangles of one mesh; their indices are 32 bits wide.
inline constexpr std::size_t kMostElements = 0x7FFFFFFF;

}  // namespace scintray
