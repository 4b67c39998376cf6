#include "scintray/mesh/import/import.hpp"

#include <algorithm>

#include "scintray/mesh/import/detail/import_steps.hpp"

namespace scintray::mesh {

/// A file as read with one tessellation, in units of the file.
struct MeshFiles::Content {
  const MeshFormats* formats;
  double deviation, angle_rad;
  RawMesh raw;
};

MeshFiles::MeshFiles() = default;
MeshFiles::~MeshFiles() = default;

void MeshFiles::announce(const std::filesystem::path& path) { ++announced_[path]; }

MeshImport MeshFiles::import(const std::filesystem::path& path, const ImportOptions& options) {
  const auto announced = announced_.find(path);
  if (announced != announced_.end() && announced->second > 0) --announced->second;
  const bool last = announced == announced_.end() || announced->second == 0;
  const auto kept = contents_.find(path);
  if (last && kept == contents_.end()) return import_mesh(path, options);

  const double deviation = options.tessellation.deviation_mm / options.scale;
  std::vector<Content>& contents = contents_[path];
  auto content = std::find_if(contents.begin(), contents.end(), [&](const Content& c) {
    return c.formats == options.formats && c.deviation == deviation &&
           c.angle_rad == options.tessellation.angle_rad;
  });
  if (content == contents.end()) {
    contents.push_back({options.formats, deviation, options.tessellation.angle_rad, read_raw(path, options)});
    content = std::prev(contents.end());
  }
  ImportOptions whole = options;
  whole.body.clear();
  MeshImport result = options.body.empty()
                          ? import_raw(path, content->raw, whole)
                          : import_raw(path, copy_of_body(path, content->raw, options.body), whole);
  if (!options.body.empty()) result.bodies = content->raw.bodies;
  if (last) contents_.erase(path);
  return result;
}

}  // namespace scintray::mesh
