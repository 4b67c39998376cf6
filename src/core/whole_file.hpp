#pragma once
/// Files that appear whole or not at all.

#include <filesystem>
#include <string_view>

namespace scintray {

/// Writes `content` beside `path` and renames it. @throws SystemError when it cannot.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

}  // namespace scintray
