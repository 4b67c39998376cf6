#pragma once
/// Isolation from Open CASCADE, which follows endless references and null pointers: a check of the file
/// before it is read, and the transfer of the mesh from a child process.

#include <filesystem>
#include <string>
#include <string_view>

#include "scintray/mesh/import/raw_mesh.hpp"
#include "scintray/mesh/tessellation.hpp"

namespace scintray::mesh {

/// Throws InputError when an entity of the file (ISO 10303-21) refers to itself, over any number of others,
/// or to one that does not exist, and when references are nested more than 10,000 deep (chosen).
void check_step_references(const std::filesystem::path& path, const std::string& content);

/// Reads and tessellates the file by Open CASCADE, whose settings and messages are one set per process:
/// called in a child process. Throws InputError for content that it cannot read or tessellate.
RawMesh read_step(const std::filesystem::path& path, const std::string& content,
                  const Tessellation& tessellation);

/// A mesh as bytes, for the transfer between two processes of one program.
std::string to_bytes(const RawMesh& raw);

/// The mesh from the bytes of to_bytes. Throws InternalError for other bytes.
RawMesh from_bytes(std::string_view bytes);

}  // namespace scintray::mesh
