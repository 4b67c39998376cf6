#pragma once
/// Files read in one go.

#include <filesystem>
#include <optional>
#include <string>

namespace scintray::core {

/// All bytes of a file as they are; nothing when it cannot be opened or read, as a folder cannot.
[[nodiscard]] [[nodiscard]] std::optional<std::string> read_whole_file(const std::filesystem::path& path);

}  // namespace scintray::core
