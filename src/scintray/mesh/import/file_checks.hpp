#pragma once
/// Looking at a mesh file before a library parses it.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace scintray::mesh {

/// Throws InputError naming `path`.
[[noreturn]] void reject_file(const std::filesystem::path& path, const std::string& what,
                              const std::string& hint = {});

/// The ending in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& path);

/// Whole content. Throws InputError when the file is missing, a folder, unreadable or empty.
[[nodiscard]] std::string read_mesh_file(const std::filesystem::path& path);

/// Refuses files whose own counts cannot be true, since parsers allocate by them before they read:
/// element counts of OFF and binary STL against the file's size; and text in UTF-16. Throws InputError.
void check_stated_sizes(const std::filesystem::path& path, const std::string& extension,
                        const std::string& content);

/// What a sound file of nested JSON values or XML elements does not come near.
inline constexpr std::size_t kDeepestNesting = 500;

/// Greatest depth of elements of an XML text, as far as its angle brackets tell.
std::size_t xml_depth(std::string_view text);

/// Greatest depth of brackets of a JSON text, strings left out.
std::size_t json_depth(const std::string& text);

}  // namespace scintray::mesh
