#pragma once
/// Reading meshes from files.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray {

struct MeshImport {
  TriMesh mesh;                          ///< mm, vertices welded, no triangle of zero area
  std::string unit_from_file;            ///< "m" for glTF; "" when the file does not say
  std::vector<std::string> notes;        ///< everything that was left out, repaired or warned about
  std::size_t degenerate_triangles = 0;  ///< triangles of the file that had no area and were kept out
};

/// Reads STL, OBJ, PLY, OFF, 3MF and COLLADA (assimp), and glTF 2.0 as .gltf or .glb (tinygltf).
///
/// All node transforms are applied; axes stay as the file has them. Polygons are cut into triangles.
/// Triangles keep the order in which the file's objects and then their faces come.
///
/// Vertices are single precision in these formats, so vertices closer than 2^-22 of the largest
/// absolute coordinate (two units in the last place) are one vertex. Triangles that then have two
/// equal vertices, or whose height is below the same length, have no area: they are kept out, and a
/// neighbour that had its long edge in common with one is cut at its middle vertex so that the mesh
/// stays closed.
///
/// Groups: glTF material name; for other formats the object or group name, the material name, or
/// "object:material" when both are given. Unnamed triangles are in the group "default".
///
/// @param mm_per_unit  length of one file unit in mm; 0 takes the file's own: glTF is in metres
///                     (glTF 2.0 specification, section 3.4), other formats need a number.
/// @throws InputError  missing, empty, unreadable or malformed file; no triangles; a vertex that is
///                     not finite; unknown extension; no unit.
MeshImport import_mesh(const std::filesystem::path& path, double mm_per_unit);

/// Endings (with the dot, lower case) that import_mesh reads.
const std::vector<std::string>& mesh_extensions();

}  // namespace scintray
