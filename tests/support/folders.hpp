#pragma once
/// Where this repository and this build lie.

#include <filesystem>

namespace scintray::test {

/// Root of the source tree, and of the build tree that the test was built in.
std::filesystem::path source_folder();
std::filesystem::path build_folder();

}  // namespace scintray::test
