#pragma once
/// Whole files in memory.

#include <filesystem>
#include <optional>
#include <string>

namespace scintray::core {

/// All bytes of a file; empty (nullopt) when it cannot be opened or read, for example a folder.
[[nodiscard]] std::optional<std::string> read_whole_file(const std::filesystem::path& path);

}  // namespace scintray::core
