#pragma once
/// What importing a mesh complains of.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/import.hpp"
#include "support/words.hpp"

namespace scintray::test {

/// The complaint of an import; "no error" when it succeeds.
inline std::string message(const std::filesystem::path& path, const mesh::ImportOptions& options = {}) {
  const std::string complaint = complaint_of([&] { mesh::import_mesh(path, options); });
  return complaint.empty() ? "no error" : complaint;
}

}  // namespace scintray::test
