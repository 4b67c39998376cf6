#include "scintray/mesh/import/mesh_format.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import/detail/formats.hpp"

namespace scintray::mesh {

MeshFormats::MeshFormats() {
  add({.extension = ".stl", .read = import_through_assimp});
  add({.extension = ".obj", .read = import_through_assimp});
  add({.extension = ".ply", .read = import_ply});
  add({.extension = ".off", .read = import_through_assimp});
  add({.extension = ".3mf", .states_unit = true, .read = import_3mf});
  add({.extension = ".dae", .states_unit = true, .read = import_collada});
  add({.extension = ".gltf", .states_unit = true, .read = import_gltf});
  add({.extension = ".glb", .states_unit = true, .read = import_glb});
  add({.extension = ".step", .states_unit = true, .is_step = true, .read = import_step});
  add({.extension = ".stp", .states_unit = true, .is_step = true, .read = import_step});
}

const MeshFormats& MeshFormats::built_in() {
  static const MeshFormats formats;
  return formats;
}

void MeshFormats::add(MeshFormat format) {
  if (format.extension.size() < 2 || format.extension.front() != '.')
    throw core::InternalError("a mesh format with the extension \"" + format.extension + "\"");
  if (find(format.extension))
    throw core::InternalError("two mesh formats with the extension \"" + format.extension + "\"");
  if (!format.read) throw core::InternalError("a mesh format without a reader: " + format.extension);
  extensions_.push_back(format.extension);
  formats_.push_back(std::move(format));
}

const MeshFormat* MeshFormats::find(const std::string& extension) const {
  const auto format = std::find_if(formats_.begin(), formats_.end(),
                                   [&](const MeshFormat& known) { return known.extension == extension; });
  return format == formats_.end() ? nullptr : &*format;
}

}  // namespace scintray::mesh
