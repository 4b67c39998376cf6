#pragma once
/// Reading zip archives.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct zip;

namespace scintray::core {

/// Limit of the unpacked size of a file. Measured heights and the numbers of meshes shrink to a fifth or a
/// tenth; a hundredth is not a measurement, but small files are accepted.
constexpr std::size_t most_unpacked(std::size_t packed) {
  return std::max(std::size_t{64} << 20, 100 * packed);
}

/// An archive in memory; the content must outlive it. Every member throws InputError with the file and the
/// entry.
class ZipArchive {
 public:
  ZipArchive(std::string_view content, std::string file);

  const std::vector<std::string>& names() const { return names_; }

  /// Unpacked size of an entry in bytes. A size that deflate cannot reach (more than 1032 times the packed
  /// one), or above most_unpacked, is an error, so this is bounded by the archive's own size.
  std::size_t size(const std::string& name) const;

  /// The content of an entry, which must have exactly `size` bytes.
  std::string read(const std::string& name, std::size_t size) const;
  /// The whole entry.
  std::string read(const std::string& name) const { return read(name, size(name)); }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const;

  std::string_view content_;
  std::string file_;
  std::unique_ptr<zip, void (*)(zip*)> archive_;
  std::vector<std::string> names_;
};

}  // namespace scintray::core
