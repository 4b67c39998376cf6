#pragma once
/// Writing a file that appears whole or not at all.

#include <filesystem>
#include <string_view>

namespace scintray {

/// Writes the bytes to a temporary file beside the target, which then takes its name. Throws SystemError
/// with the file's name when it cannot.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace scintray
