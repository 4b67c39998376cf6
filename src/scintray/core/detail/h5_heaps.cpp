// Heaps of texts in HDF5 files, before HDF5 walks through them.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <string_view>

#include "scintray/core/detail/h5_internal.hpp"

namespace scintray::core::h5 {

namespace {

constexpr std::string_view kSignature = "GCOL";
constexpr std::size_t kHeader = 16;  // of a heap, and of an object in it

template <typename T>
T number_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// The bytes begin with a heap. One that does not fit into them is left to HDF5, which refuses it.
bool is_endless(std::string_view bytes) {
  if (bytes.size() < kHeader || bytes[4] != 1) return false;
  const auto size = number_at<std::uint64_t>(bytes.data() + 8);
  if (size > bytes.size()) return false;
  for (std::size_t at = kHeader; at + kHeader <= size;) {
    const auto index = number_at<std::uint16_t>(bytes.data() + at);
    const auto length = number_at<std::uint64_t>(bytes.data() + at + 8);
    // Object 0 is the free space, whose length includes its header.
    const std::uint64_t step = index == 0 ? length : kHeader + ((length + 7) & ~std::uint64_t{7});
    if (step == 0 || (index != 0 && step < length)) return true;
    if (step > size - at) return false;
    at += step;
  }
  return false;
}

/// A file in memory, as long as it lives.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return;
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && status.st_size > 0) {
      size_ = static_cast<std::size_t>(status.st_size);
      begin_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
    }
    ::close(descriptor);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile() {
    if (begin_ != MAP_FAILED) ::munmap(begin_, size_);
  }
  /// Empty when the file could not be mapped.
  std::string_view bytes() const {
    return begin_ == MAP_FAILED ? std::string_view()
                                : std::string_view(static_cast<const char*>(begin_), size_);
  }

 private:
  void* begin_ = MAP_FAILED;
  std::size_t size_ = 0;
};

}  // namespace

bool has_endless_heap(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  for (std::size_t at = bytes.find(kSignature); at != std::string_view::npos;
       at = bytes.find(kSignature, at + 1))
    if (is_endless(bytes.substr(at))) return true;
  return false;
}

}  // namespace scintray::core::h5
