#include "scintray/core/data_folder.hpp"

#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::core {

namespace {

namespace fs = std::filesystem;

bool holds_data(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "materials", ignored);
}

/// Folders to try, in order, when the user names none.
std::vector<fs::path> usual_folders() {
  std::vector<fs::path> folders;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) folders.push_back(program.parent_path().parent_path() / "share" / "scintray");
  folders.emplace_back(SCINTRAY_SOURCE_FOLDER);
  folders.emplace_back(SCINTRAY_INSTALL_FOLDER);
  return folders;
}

}  // namespace

fs::path data_folder() {
  if (const char* named = std::getenv("SCINTRAY_DATA"); named != nullptr && *named != '\0') {
    if (holds_data(named)) return named;
    throw InputError({{},
                      "SCINTRAY_DATA is \"" + std::string(named) + "\", which has no folder \"materials\"",
                      "set it to the folder that holds materials/, or unset it"});
  }
  std::string tried;
  for (const fs::path& folder : usual_folders()) {
    if (holds_data(folder)) return folder;
    tried += (tried.empty() ? "" : ", ") + folder.string();
  }
  throw SystemError("the data of ScintRay (materials, scenes) was not found in any of " + tried +
                    "; set SCINTRAY_DATA to the folder that holds materials/");
}

}  // namespace scintray::core
