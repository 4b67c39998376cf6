#include "scintray/core/input_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>

#include "scintray/core/sha256.hpp"

namespace scintray::core {

namespace {

/// The innermost record of this thread: readers are called through many interfaces without a record.
thread_local InputRecord* innermost = nullptr;

constexpr std::size_t kPart = 1 << 16;

/// At most `most` bytes of a regular file.
std::optional<std::string> read_up_to(const std::filesystem::path& path, std::uintmax_t most) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return std::nullopt;  // reading a pipe could wait for ever
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::string content;
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown) content.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(size, most)));
  std::array<char, kPart> part{};
  while (file && content.size() < most) {
    file.read(part.data(),
              static_cast<std::streamsize>(std::min<std::uintmax_t>(part.size(), most - content.size())));
    content.append(part.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) return std::nullopt;
  return content;
}

}  // namespace

InputRecord::InputRecord() : outer_(innermost) { innermost = this; }

InputRecord::~InputRecord() { innermost = outer_; }

void InputRecord::add(const std::filesystem::path& path, std::string_view content) {
  if (innermost != nullptr && !innermost->hashes_.contains(path))
    innermost->hashes_[path] = core::sha256(content);
}

void InputRecord::add(const std::filesystem::path& path) {
  if (innermost == nullptr || innermost->hashes_.contains(path)) return;
  std::ifstream file(path, std::ios::binary);
  if (!file) return;
  Sha256 hash;
  std::array<char, kPart> part{};
  while (file) {
    file.read(part.data(), part.size());
    hash.add({part.data(), static_cast<std::size_t>(file.gcount())});
  }
  if (!file.bad()) innermost->hashes_[path] = hash.hex();
}

std::vector<InputFile> InputRecord::files() const {
  std::vector<InputFile> files;
  for (const auto& [path, hash] : hashes_) files.push_back({path.filename().string(), hash});
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

std::optional<std::string> read_whole_file(const std::filesystem::path& path) {
  std::optional<std::string> content = read_up_to(path, std::numeric_limits<std::uintmax_t>::max());
  if (content) InputRecord::add(path, *content);
  return content;
}

std::optional<std::string> read_beginning(const std::filesystem::path& path, std::size_t most) {
  return read_up_to(path, most);
}

}  // namespace scintray::core
