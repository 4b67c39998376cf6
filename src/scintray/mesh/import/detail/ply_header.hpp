#pragma once
/// The header of a PLY file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scintray::mesh {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyType {
  enum class Kind { signed_integer, unsigned_integer, floating };
  Kind kind = Kind::floating;
  std::size_t bytes = 4;
};

struct PlyProperty {
  std::string name;
  PlyType type;
  bool is_list = false;
  PlyType count_type;  ///< of the number before a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_start = 0;  ///< first byte after the header's last line
};

/// Throws InputError with the line number for lines that PLY 1.0 does not know and for elements that
/// announce more members than the content has bytes.
PlyHeader read_ply_header(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray::mesh
