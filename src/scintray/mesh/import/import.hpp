#pragma once
/// Import of meshes from files, as a whole or body by body.

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Options for the import of a mesh file.
struct ImportOptions {
  /// Length of one unit of the file in mm; 0: the unit that the file or its format states.
  double mm_per_unit = 0.0;
  double scale = 1.0;         ///< extra factor
  std::string body;           ///< name or number (from 1 on) of the one body to import; empty: all of them
  Tessellation tessellation;  ///< of curved CAD faces, after `scale`
  /// Formats that can be read; must outlive the import. External formats are added to a list of the
  /// caller's.
  const MeshFormats* formats = &MeshFormats::built_in();
};

struct MeshImport {
  TriMesh mesh;                          ///< mm, vertices welded, no triangle of zero area
  std::string unit_from_file;            ///< "m" for glTF; "" when the file states none
  std::vector<std::string> notes;        ///< everything that was left out, repaired or warned about
  std::size_t degenerate_triangles = 0;  ///< triangles of the file without area, left out
  std::vector<std::string> bodies;       ///< all bodies of the file; empty when its format has none
};

/// Mesh of a file: STL, OBJ, OFF (assimp), PLY, 3MF and COLLADA (own readers), glTF 2.0 as .gltf or .glb
/// (tinygltf), and STEP (Open CASCADE, when it was available at build time).
///
/// All node transforms are applied; the axes are those of the file. Polygons are cut into triangles.
/// Triangles keep the order in which the file's objects and then their faces come.
///
/// Vertices are single precision in most of these formats, so vertices closer than 2^-22 of the largest
/// absolute coordinate (two units in the last place) are one vertex. Triangles that then have two
/// equal vertices, or whose height is below the same length, have no area: they are left out, and a
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
/// the material and the primitive, the later ones taking precedence; "color" and "face" of a CAD face.
///
/// @throws InputError  missing, empty, unreadable or malformed file; no triangles; a vertex that is
///                     not finite; unknown extension; no unit, or one that contradicts the file; no such
///                     body; a tessellation finer than a millionth of the body.
MeshImport import_mesh(const std::filesystem::path& path, const ImportOptions& options);

/// The same with only a unit: see ImportOptions::mm_per_unit.
MeshImport import_mesh(const std::filesystem::path& path, double mm_per_unit);

/// Extensions (with the dot, lower case) of the built-in formats.
const std::vector<std::string>& mesh_extensions();

/// True for an extension (with the dot, lower case) of STEP, whose curved faces are tessellated.
bool is_step(const std::string& extension);

/// True for an extension (with the dot, lower case) whose files or format state the unit of length. False for
/// an extension that is not built in.
bool states_its_unit(const std::string& extension);

struct RawMesh;

/// Imports mesh files, and reads each only once where further imports of it are announced: an assembly of
/// hundreds of bodies, each a part of its own, is one file.
class MeshFiles {
 public:
  MeshFiles();
  ~MeshFiles();
  MeshFiles(const MeshFiles&) = delete;
  MeshFiles& operator=(const MeshFiles&) = delete;

  /// Announces one more import of this file. Its content is kept until all announced imports are made.
  void announce(const std::filesystem::path& path);

  /// As import_mesh(path, options).
  MeshImport import(const std::filesystem::path& path, const ImportOptions& options);

 private:
  struct Content;
  std::map<std::filesystem::path, std::size_t> announced_;
  std::map<std::filesystem::path, std::vector<Content>> contents_;
};

}  // namespace scintray::mesh
