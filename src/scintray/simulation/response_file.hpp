#pragma once
/// Response maps in files: HDF5, described field by field in docs/response_maps.md.

#include <filesystem>
#include <string>

#include "scintray/simulation/response_map.hpp"

namespace scintray::simulation {

/// Version of the layout; grows when a reader of the older one would misread the newer.
inline constexpr std::int64_t kResponseVersion = 1;

/// A map and where it comes from.
struct ResponseFile {
  ResponseMap map;         ///< as read, grids know their parts and not their regions
  std::string version;     ///< of ScintRay
  std::string scene_file;  ///< as it was named
  std::string scene_text;  ///< the whole scene file
};

/// Throws InputError when `path` is taken by something that is not a response map, SystemError when it cannot
/// be written.
void write_response(const std::filesystem::path& path, const ResponseFile& file);

/// Throws what write_response would before anything is traced for it.
void check_response_path(const std::filesystem::path& path);

/// Throws InputError when the file is missing, is not a response map, has a version this program does not
/// read or contradicts itself.
ResponseFile read_response(const std::filesystem::path& path);

}  // namespace scintray::simulation
