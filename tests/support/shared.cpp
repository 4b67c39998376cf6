#include "support/shared.hpp"

#include <iostream>

namespace scintray::test {

std::optional<std::filesystem::path> shared_file(const std::string& relative) {
  const auto path = std::filesystem::path(SCINTRAY_SOURCE_DIR).parent_path() / "shared" / relative;
  if (std::filesystem::exists(path)) return path;
  std::cout << "[skipped] reference data not on this machine: shared/" << relative << "\n";
  return std::nullopt;
}

std::filesystem::path source_file(const std::string& relative) {
  return std::filesystem::path(SCINTRAY_SOURCE_DIR) / relative;
}

std::filesystem::path scratch_folder(const std::string& name) {
  const auto path = std::filesystem::path(SCINTRAY_BINARY_DIR) / "test-scratch" / name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path;
}

}  // namespace scintray::test
