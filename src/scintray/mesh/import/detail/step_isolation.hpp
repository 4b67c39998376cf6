#pragma once
/// Keeping this process safe from Open CASCADE, which follows references without an end and null pointers:
/// the check before it reads a file, and the way of its mesh out of a process of its own.

#include <filesystem>
#include <string>
#include <string_view>

#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {

/// Throws InputError when an entity of the file (ISO 10303-21) refers to itself, over however many others, or
/// to one that is not there, and when references are nested more than 10,000 deep.
void check_step_references(const std::filesystem::path& path, const std::string& content);

/// A mesh on its way between two processes of one program.
std::string to_bytes(const RawMesh& raw);

/// Throws InternalError when the bytes are not those of to_bytes.
RawMesh from_bytes(std::string_view bytes);

}  // namespace scintray::mesh
