#pragma once
/// The file formats that meshes are read from.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scintray/mesh/import/raw_mesh.hpp"
#include "scintray/mesh/tessellation.hpp"

namespace scintray::mesh {

/// A mesh file as the reader of its format receives it; all live as long as the reader runs.
struct MeshFile {
  const std::filesystem::path& path;  ///< for messages, and for files beside it
  const std::string& content;         ///< all bytes, at least one
  const Tessellation& tessellation;   ///< of curved faces, in mm before any scale
};

/// One file format.
struct MeshFormat {
  std::string extension;     ///< of its files, with the dot, lower case; each has one format
  bool states_unit = false;  ///< the file, or its format, states the unit; otherwise the user has to
  bool is_step = false;      ///< CAD: faces may be curved, and are cut in triangles
  /// Reads a file. Throws InputError, naming the path, for content that is not of this format; indices of
  /// vertices and groups are in range.
  std::function<RawMesh(const MeshFile& file)> read;
};

/// A list of formats, told apart by the file's extension. Constant once filled: many threads may then read
/// meshes with it.
class MeshFormats {
 public:
  /// The formats that are built in.
  MeshFormats();
  static const MeshFormats& built_in();

  /// Adds a format. Throws InternalError when its extension is none, or is taken, or it has no reader.
  void add(MeshFormat format);

  /// The format of an extension (with the dot, lower case), or nullptr.
  [[nodiscard]] const MeshFormat* find(const std::string& extension) const;
  /// All extensions, built-in ones first.
  const std::vector<std::string>& extensions() const { return extensions_; }

 private:
  std::vector<MeshFormat> formats_;
  std::vector<std::string> extensions_;
};

}  // namespace scintray::mesh
