#pragma once

#include <filesystem>

namespace scintray::bench {

/// Folder of the scene files, tools/benchmark/scenes of the source tree.
std::filesystem::path scene_folder();

/// CMake's build type and compiler flags of this program: "Release -O3 -DNDEBUG".
const char* build_flags();

}  // namespace scintray::bench
