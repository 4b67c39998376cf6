#pragma once
/// Whole files in memory.

#include <filesystem>
#include <optional>
#include <string>

namespace scintray::core {

/// All bytes of a regular file; empty (nullopt) for a folder, a pipe or a device, and when it cannot be
/// opened or read.
[[nodiscard]] std::optional<std::string> read_whole_file(const std::filesystem::path& path);

}  // namespace scintray::core
