#pragma once
/// STEP through Open CASCADE.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/detail/raw_mesh.hpp"
#include "scintray/mesh/tessellation.hpp"

namespace scintray::mesh {

/// Reads STEP (ISO 10303-21; AP203, AP214, AP242) and cuts its faces in triangles. Coordinates come out in
/// mm; the file's own unit is stated in RawMesh::unit.
///
/// Bodies are solids, each instance of an assembly one of its own, called after its product; a product
/// without solids is one body of its shells. Every CAD face is a group, called after its name, else its
/// colour ("#rrggbb", sRGB), else its number in the file ("face12"); its tags are "face", the number, and
/// "color", its own colour or that of its solid or product.
///
/// Throws InputError for content that is not STEP, that has no faces, or that Open CASCADE cannot read or
/// cut; for a deviation below a millionth of the size of the shape; and when ScintRay was built without
/// Open CASCADE.
RawMesh import_step(const std::filesystem::path& path, const std::string& content,
                    const Tessellation& tessellation);

}  // namespace scintray::mesh
