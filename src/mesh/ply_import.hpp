#pragma once
/// PLY through CGAL: assimp up to 5.3 skips data bytes of binary files that look like white space
/// after the header, and aborts or reads wrong coordinates.

#include <filesystem>
#include <string>

#include "scintray/mesh/raw_mesh.hpp"

namespace scintray {

/// Reads PLY content, ASCII or binary of either byte order, whose claimed sizes were checked.
/// Coordinates keep double precision. One group, "default". Throws InputError when malformed.
RawMesh import_ply(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray
