#pragma once
/// Numbers separated by white space, plain or packed by zlib: how Geant4 keeps its surface tables.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::exchange {

/// How many numbers a file holds.
struct NumberCount {
  std::size_t least = 0, most = 0;
};

/// The numbers of `content`, a text or one zlib stream (RFC 1950) of such a text; which of the two, the
/// content itself states. Memory grows with what is there, at most to `count.most` numbers; what a stream
/// unpacks to is read in pieces and never kept. InputError, naming `file` and the number, when a word is no
/// number or not finite, when there are too few or too many, and when the stream is damaged, unpacks to more
/// than 32 bytes a number, or is followed by something.
std::vector<float> parse_numbers(std::string_view content, const std::string& file, NumberCount count);

/// The content of a file of `count` numbers; InputError when it cannot be read or is larger than 32 bytes a
/// number.
std::string load_number_file(const std::filesystem::path& path, NumberCount count);

}  // namespace scintray::exchange
