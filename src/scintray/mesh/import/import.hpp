#pragma once
/// Reading meshes from files.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// How a mesh file is to be taken.
struct ImportOptions {
  /// Length of one unit of the file in mm; 0 takes the unit that the file or its format states.
  double mm_per_unit = 0.0;
  double scale = 1.0;         ///< extra factor
  std::string body;           ///< name of the one body to take, or its number from 1 on; empty: all of them
  Tessellation tessellation;  ///< of curved CAD faces, after `scale`
  /// What may be read; lives as long as the reading. Formats from outside are added to a list of the
  /// caller's.
  const MeshFormats* formats = &MeshFormats::built_in();
};

struct MeshImport {
  TriMesh mesh;                          ///< mm, vertices welded, no triangle of zero area
  std::string unit_from_file;            ///< "m" for glTF; "" when the file does not state
  std::vector<std::string> notes;        ///< everything that was left out, repaired or warned about
  std::size_t degenerate_triangles = 0;  ///< triangles of the file that had no area and were kept out
  std::vector<std::string> bodies;       ///< all bodies of the file; empty when its format has none
};

/// Reads STL, OBJ, OFF (assimp), PLY, 3MF and COLLADA (here), glTF 2.0 as .gltf or .glb (tinygltf), and
/// STEP (Open CASCADE, when it was there at build time).
///
/// All node transforms are applied; axes stay as the file has them. Polygons are cut into triangles.
/// Triangles keep the order in which the file's objects and then their faces come.
///
/// Vertices are single precision in most of these formats, so vertices closer than 2^-22 of the largest
/// absolute coordinate (two units in the last place) are one vertex. Triangles that then have two
/// equal vertices, or whose height is below the same length, have no area: they are kept out, and a
/// neighbour that had its long edge in common with one is cut at its middle vertex so that the mesh
/// stays closed.
///
/// Units: 3MF, COLLADA and STEP files state theirs; glTF is in metres (glTF 2.0 specification, section
/// 3.4), as is COLLADA that states none (COLLADA 1.5 specification, section 5, "unit"); STL, OBJ, PLY and
/// OFF need mm_per_unit. An mm_per_unit other than what the file itself states is an error; one other than
/// what only the format prescribes replaces it, with a note.
///
/// Groups: glTF material name; name, else colour ("#rrggbb"), else number ("face12") of a CAD face; for
/// other formats the object or group name, the material name, or "object:material" when both are given.
/// Unnamed triangles are in the group "default". Tags of groups: scalar glTF extras of the nodes, the mesh,
/// the material and the primitive, the later ones winning; "color" and "face" of a CAD face.
///
/// @throws InputError  missing, empty, unreadable or malformed file; no triangles; a vertex that is
///                     not finite; unknown extension; no unit, or one that contradicts the file; no such
///                     body; a tessellation finer than a millionth of the body.
MeshImport import_mesh(const std::filesystem::path& path, const ImportOptions& options);

/// The same with nothing but a unit: see ImportOptions::mm_per_unit.
MeshImport import_mesh(const std::filesystem::path& path, double mm_per_unit);

/// Endings (with the dot, lower case) of the formats that are built in.
const std::vector<std::string>& mesh_extensions();

/// Whether the ending (with the dot, lower case) is that of STEP, whose curved faces are cut in triangles.
bool is_step(const std::string& extension);

/// Whether files of this ending (with the dot, lower case) say in which unit they are, or their format
/// does. False for one that is not built in.
bool states_its_unit(const std::string& extension);

}  // namespace scintray::mesh
