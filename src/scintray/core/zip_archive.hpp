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

/// What a packed file may unpack to: measured heights and the numbers of meshes shrink to a fifth or a tenth,
/// and a hundredth is no measurement, but small files are let through.
constexpr std::size_t most_unpacked(std::size_t packed) {
  return std::max(std::size_t{64} << 20, 100 * packed);
}

/// An archive in memory; the content must outlive it. Every member throws InputError with the file and
/// the entry.
class ZipArchive {
 public:
  ZipArchive(std::string_view content, std::string file);

  const std::vector<std::string>& names() const { return names_; }

  /// Unpacked size of an entry. What deflate cannot have packed so small (more than 1032 times), and
  /// more than most_unpacked allows, is refused, so this is bounded by the archive's own size.
  std::size_t size(const std::string& name) const;

  /// The first `size` bytes of an entry, which must have exactly so many.
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
