#pragma once
/// Checks of a mesh file before a library parses it.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace scintray::mesh {

/// Throws InputError naming `path`.
[[noreturn]] void reject_file(const std::filesystem::path& path, const std::string& what,
                              const std::string& hint = {});

/// Extension of the path in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& path);

/// Content of a file. Throws InputError when it is missing, a folder, unreadable or empty.
[[nodiscard]] std::string read_mesh_file(const std::filesystem::path& path);

/// Path of the file that a mesh file names: relative, in its folder or below, links resolved. Throws
/// InputError when it is elsewhere, does not exist, or is no regular file: an untrusted file may name a
/// pipe, a device or the user's own files.
[[nodiscard]] std::filesystem::path file_beside(const std::filesystem::path& path, const std::string& name);

/// Throws InputError for files whose stated counts are impossible, since parsers allocate by them before they
/// read: element counts of OFF and binary STL against the file's size; and for text in UTF-16.
void check_stated_sizes(const std::filesystem::path& path, const std::string& extension,
                        const std::string& content);

/// Limit of the nesting of JSON values or XML elements, far above that of any valid file.
inline constexpr std::size_t kDeepestNesting = 500;

/// Greatest depth of elements of an XML text, derived from its angle brackets outside comments, in linear
/// time.
std::size_t xml_depth(std::string_view text);

/// Greatest depth of brackets of a JSON text, outside strings.
std::size_t json_depth(const std::string& text);

}  // namespace scintray::mesh
