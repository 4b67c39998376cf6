#pragma once
/// A zip archive in memory. Internal to the readers.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct zip;

namespace scintray {

/// Opens an archive; the content must outlive it. Every member throws InputError with the file and
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

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const;

  std::string_view content_;
  std::string file_;
  std::unique_ptr<zip, void (*)(zip*)> archive_;
  std::vector<std::string> names_;
};

}  // namespace scintray
