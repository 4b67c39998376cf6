#pragma once
/// Height maps in files.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "scintray/topography/height_map.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

namespace scintray::test {

/// A file with this content in a folder of this process.
inline std::filesystem::path written(const std::string& name, const std::string& content) {
  static const auto folder = scratch_folder("height_maps");
  std::ofstream(folder / name, std::ios::binary) << content;
  return folder / name;
}

inline long missing_points(const topography::HeightMap& map) {
  return std::count_if(map.heights_um.begin(), map.heights_um.end(), [](double h) { return std::isnan(h); });
}

/// All that is wrong with a file, in one text; empty when it is read.
inline std::string complaint(const std::filesystem::path& path, const topography::ReadOptions& options = {}) {
  return complaint_of([&] { topography::read_height_map(path, options); });
}

}  // namespace scintray::test
