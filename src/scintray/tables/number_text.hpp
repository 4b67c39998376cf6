#pragma once
/// Numbers separated by white space, plain or compressed by zlib: the format of Geant4's surface tables.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::tables {

/// Limits of the count of numbers in a file.
struct NumberCount {
  std::size_t least = 0, most = 0;
};

/// The numbers of `content`, a text or one zlib stream (RFC 1950) of such a text, which is detected. Memory
/// grows with the content, at most to `count.most` numbers; the unpacked stream is read in pieces and never
/// kept. InputError, naming `file` and the number, when a word is not a number or not finite, when there are
/// too few or too many, and when the stream is damaged, unpacks to more than 32 bytes per number, or is
/// followed by other data.
std::vector<float> parse_numbers(std::string_view content, const std::string& file, NumberCount count);

/// The content of a file of `count` numbers; InputError when it cannot be read or is larger than 32 bytes per
/// number.
std::string load_number_file(const std::filesystem::path& path, NumberCount count);

}  // namespace scintray::tables
