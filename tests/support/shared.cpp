#include "support/shared.hpp"

#include <unistd.h>

#include <cstdlib>
#include <iostream>

#include "support/folders.hpp"

namespace scintray::test {

namespace {

/// The scratch folders of this process: tests run side by side, each in a process of its own, and none
/// may empty another's folder.
class ScratchFolders {
 public:
  ~ScratchFolders() {
    if (getpid() != owner_) return;  // a fork of the test program
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  std::filesystem::path make(const std::string& name) const {
    const auto path = root_ / name;
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
    return path;
  }

 private:
  pid_t owner_ = getpid();
  std::filesystem::path root_ = build_folder() / "test-scratch" / std::to_string(owner_);
};

}  // namespace

std::optional<std::filesystem::path> shared_file(const std::string& relative) {
  const auto path = source_folder().parent_path() / "shared" / relative;
  if (std::filesystem::exists(path)) return path;
  std::cout << "[skipped] reference data not on this machine: shared/" << relative << "\n";
  return std::nullopt;
}

std::filesystem::path source_file(const std::string& relative) { return source_folder() / relative; }

std::filesystem::path program_file() { return build_folder() / "bin" / "scintray"; }

std::filesystem::path scratch_folder(const std::string& name) {
  static const ScratchFolders folders;
  return folders.make(name);
}

std::filesystem::path tables_of_this_run() {
  static const std::filesystem::path folder = [] {
    const auto of_ctest = build_folder() / "test-tables";  // tests/CMakeLists.txt
    const char* named = std::getenv("SCINTRAY_CACHE");
    return named && of_ctest == named ? of_ctest : scratch_folder("tables");
  }();
  return folder;
}

}  // namespace scintray::test
