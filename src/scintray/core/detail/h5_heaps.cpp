// Heaps of texts in HDF5 files, before HDF5 walks through them.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>

#include "scintray/core/detail/h5_internal.hpp"

namespace scintray::core::h5 {

namespace {

constexpr std::string_view kSignature = "GCOL";
constexpr std::size_t kHeader = 16;     // of a heap, and of an object in it
constexpr std::size_t kReference = 16;  // length, address of the heap, number of the object

template <typename T>
T number_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Calls `found(index, bytes)` for each object of the heap with which the bytes begin, until it returns true.
/// A heap that does not fit into them is left to HDF5, which refuses it.
/// @returns  false when the walk would not come to an end
template <typename Found>
bool walk(std::string_view bytes, const Found& found) {
  if (bytes.size() < kHeader || bytes[4] != 1) return true;
  const auto size = number_at<std::uint64_t>(bytes.data() + 8);
  if (size > bytes.size()) return true;
  for (std::size_t at = kHeader; at + kHeader <= size;) {
    const auto index = number_at<std::uint16_t>(bytes.data() + at);
    const auto length = number_at<std::uint64_t>(bytes.data() + at + 8);
    // Object 0 is the free space, whose length includes its header.
    const std::uint64_t step = index == 0 ? length : kHeader + ((length + 7) & ~std::uint64_t{7});
    if (step == 0 || (index != 0 && step < length)) return false;
    if (step > size - at) return true;
    if (index != 0 && found(index, length)) return true;
    at += step;
  }
  return true;
}

}  // namespace

TextHeaps::TextHeaps(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    begin_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (begin_ == MAP_FAILED) begin_ = nullptr;
  }
  ::close(descriptor);
  // The file begins at byte 0, 512, 1024, 2048, ... (section II.A).
  const std::string_view all = bytes();
  for (std::uint64_t at = 0; at < all.size(); at = at == 0 ? 512 : 2 * at)
    if (all.substr(at).starts_with("\x89HDF\r\n\x1a\n")) {
      base_ = at;
      break;
    }
}

TextHeaps::~TextHeaps() {
  if (begin_ != nullptr) ::munmap(begin_, size_);
}

std::string_view TextHeaps::bytes() const {
  return begin_ == nullptr ? std::string_view() : std::string_view(static_cast<const char*>(begin_), size_);
}

bool TextHeaps::endless() const {
  const std::string_view all = bytes();
  for (std::size_t at = all.find(kSignature); at != std::string_view::npos; at = all.find(kSignature, at + 1))
    if (!walk(all.substr(at), [](std::uint16_t, std::uint64_t) { return false; })) return true;
  return false;
}

bool TextHeaps::have(std::uint64_t from, std::uint64_t count) const {
  const std::string_view all = bytes();
  if (from > all.size() || count > (all.size() - from) / kReference) return false;
  using Lengths = std::map<std::uint32_t, std::uint64_t>;  // of the objects of a heap
  std::map<std::uint64_t, Lengths> heaps;
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* reference = all.data() + from + i * kReference;
    const auto length = number_at<std::uint32_t>(reference);
    const auto heap = number_at<std::uint64_t>(reference + 4);
    const auto index = number_at<std::uint32_t>(reference + 12);
    if (heap == 0) continue;  // no text
    if (heap >= all.size() - base_ || !all.substr(base_ + heap).starts_with(kSignature)) return false;
    const auto [place, is_new] = heaps.try_emplace(heap);
    Lengths& objects = place->second;
    if (is_new)
      walk(all.substr(base_ + heap), [&objects](std::uint16_t of, std::uint64_t bytes_of) {
        objects[of] = bytes_of;
        return false;
      });
    const auto object = objects.find(index);
    if (object == objects.end() || object->second < length) return false;
  }
  return true;
}

bool TextHeaps::have_attribute(std::uint64_t header, const std::string& attribute,
                               std::uint64_t count) const {
  const std::optional<std::uint64_t> at = attribute_values_at(bytes(), base_, header, attribute);
  return !at || have(*at, count);
}

}  // namespace scintray::core::h5
