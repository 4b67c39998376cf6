#include "support/folders.hpp"

namespace scintray::test {

std::filesystem::path source_folder() { return SCINTRAY_SOURCE_DIR; }

std::filesystem::path build_folder() { return SCINTRAY_BINARY_DIR; }

}  // namespace scintray::test
