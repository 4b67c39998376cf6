#include "build_facts.hpp"

namespace scintray::bench {

// The only file that knows the paths and flags of the build, so that a compiler cache serves every clone.
std::filesystem::path scene_folder() { return SCINTRAY_BENCH_SCENES; }
const char* build_flags() { return SCINTRAY_BENCH_FLAGS; }

}  // namespace scintray::bench
