#include "scintray/mesh/import/mesh_format.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"

namespace scintray::mesh {

// The formats that are built in, a line each: the function that reads a file, which detail/NAME_import.cpp
// defines, and the format's properties. It throws InputError for content that is malformed.
#define SCINTRAY_MESH_FORMATS(ADD)                                             \
  ADD(import_through_assimp, .extension = ".stl")                              \
  ADD(import_through_assimp, .extension = ".obj")                              \
  ADD(import_ply, .extension = ".ply")                                         \
  ADD(import_off, .extension = ".off")                                         \
  ADD(import_3mf, .extension = ".3mf", .states_unit = true)                    \
  ADD(import_collada, .extension = ".dae", .states_unit = true)                \
  ADD(import_gltf, .extension = ".gltf", .states_unit = true)                  \
  ADD(import_glb, .extension = ".glb", .states_unit = true)                    \
  ADD(import_step, .extension = ".step", .states_unit = true, .is_step = true) \
  ADD(import_step, .extension = ".stp", .states_unit = true, .is_step = true)

#define SCINTRAY_DECLARE(function, ...) RawMesh function(const MeshFile& file);
SCINTRAY_MESH_FORMATS(SCINTRAY_DECLARE)
#undef SCINTRAY_DECLARE

MeshFormats::MeshFormats() {
#define SCINTRAY_ADD(function, ...) add({__VA_ARGS__, .read = function});
  SCINTRAY_MESH_FORMATS(SCINTRAY_ADD)
#undef SCINTRAY_ADD
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
