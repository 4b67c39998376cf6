#pragma once
/// PLY, read here: assimp up to 5.3 skips data bytes of binary files that look like white space after
/// the header, and CGAL 5.5 crashes on headers whose lines stand in an unexpected order.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/detail/raw_mesh.hpp"

namespace scintray::mesh {

/// Reads PLY content (G. Turk 1994, "The PLY Polygon File Format", version 1.0), ASCII or binary of
/// either byte order. Coordinates keep double precision. One group, "default". Elements other than
/// "vertex" and "face" are left out with a note. Throws InputError when malformed; time and memory are
/// bounded by the length of the content.
RawMesh import_ply(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray::mesh
