#pragma once
/// Mesh files that are imported several times, body by body.

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "scintray/mesh/import/import.hpp"

namespace scintray::mesh {

struct RawMesh;

/// Imports mesh files, and reads each only once where further imports of it are announced: an assembly of
/// hundreds of bodies, each a part of its own, is one file.
class MeshFiles {
 public:
  MeshFiles();
  ~MeshFiles();
  MeshFiles(const MeshFiles&) = delete;
  MeshFiles& operator=(const MeshFiles&) = delete;

  /// One more import of this file is to come. Its content is kept until as many have been made.
  void announce(const std::filesystem::path& path);

  /// As import_mesh(path, options).
  MeshImport import(const std::filesystem::path& path, const ImportOptions& options);

 private:
  struct Content;
  std::map<std::filesystem::path, std::size_t> announced_;
  std::map<std::filesystem::path, std::vector<Content>> contents_;
};

}  // namespace scintray::mesh
