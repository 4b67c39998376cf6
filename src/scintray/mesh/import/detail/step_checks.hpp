#pragma once
/// Looking at a STEP file before Open CASCADE does, which follows references without an end.

#include <filesystem>
#include <string>

namespace scintray::mesh {

/// Throws InputError when an entity of the file (ISO 10303-21) refers to itself, over however many others, or
/// to one that is not there, and when references are nested more than 10,000 deep.
void check_step_references(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray::mesh
