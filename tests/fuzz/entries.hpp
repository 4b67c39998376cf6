#pragma once
/// What is thrown at each reader: bytes that may be a file of its format, or damaged, or made to
/// harm. The same entries serve the test here and libFuzzer (docs/height_maps.md states how).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scintray::fuzz {

struct Entry {
  const char* name;
  /// Runs the reader. What it reads must be a whole map that the bytes can hold, and what it throws
  /// an InputError with a place and words; anything else leaves as an exception. True when all was
  /// read.
  bool (*run)(const std::uint8_t* data, std::size_t size);
  std::vector<std::string> (*seeds)();  ///< sound files to begin with
  /// Most bytes that may be requested at once, per byte of input.
  std::size_t bytes_per_byte;
  /// Room for what does not grow with the file: maps of units, a chunk of an unpacker.
  std::size_t always_allowed = std::size_t{1} << 20;
};

/// Height maps and surface tables.
std::span<const Entry> entries();

}  // namespace scintray::fuzz
