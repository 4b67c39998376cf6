#pragma once
/// A RawMesh on its way between two processes of one program.

#include <string>
#include <string_view>

#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {

std::string to_bytes(const RawMesh& raw);

/// Throws InternalError when the bytes are not those of to_bytes.
RawMesh from_bytes(std::string_view bytes);

}  // namespace scintray::mesh
