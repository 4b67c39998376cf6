#pragma once
/// Rules of the repository's layout, checked by reading its files.

#include <filesystem>
#include <string>
#include <vector>

namespace scintray::test {

/// One rule broken: "file:line: what".
using Violations = std::vector<std::string>;

/// The layers in order, from the SCINTRAY_MODULES of `source`/CMakeLists.txt.
std::vector<std::string> read_layers(const std::filesystem::path& source);

/// Includes and CMake links in `source` (the folder src/) that point up, or to a module that is not
/// one of the layers; quoted includes not written as "scintray/module/header.hpp"; folders with code
/// that are not one of the layers.
Violations find_upward_includes(const std::filesystem::path& source);
Violations find_upward_links(const std::filesystem::path& source);
Violations find_unlisted_modules(const std::filesystem::path& source);

/// Source code or scripts in a folder that may hold data only.
Violations find_code_among_data(const std::filesystem::path& folder);

/// Absolute paths of somebody's machine in the text files of a repository, build and git folders
/// left out.
Violations find_machine_paths(const std::filesystem::path& repository);

}  // namespace scintray::test
