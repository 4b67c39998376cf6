#include "scintray/core/zip_archive.hpp"

#include <zip.h>

#include "scintray/core/error.hpp"

namespace scintray::core {

namespace {

/// A run of 258 equal bytes takes two bits at best (RFC 1951, section 3.2.5).
constexpr std::uint64_t kMostDeflateRatio = 1032, kSmallFile = 1024;
constexpr zip_int64_t kMostEntries = 10000;

}  // namespace

ZipArchive::ZipArchive(std::string_view content, std::string file)
    : content_(content), file_(std::move(file)), archive_(nullptr, zip_discard) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
  if (source) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (!archive_) {
    const std::string reason = zip_error_strerror(&error);
    if (source) zip_source_free(source);
    zip_error_fini(&error);
    fail("damaged zip archive: " + reason, "the file is truncated or damaged");
  }
  zip_error_fini(&error);
  const zip_int64_t entries = zip_get_num_entries(archive_.get(), 0);
  if (entries > kMostEntries)
    fail(std::to_string(entries) + " files in a zip archive, more than any file that is read here has", "");
  for (zip_int64_t k = 0; k < entries; ++k)
    if (const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(k), 0))
      names_.push_back(name);
}

void ZipArchive::fail(const std::string& what, const std::string& hint) const {
  throw InputError({{file_}, what, hint});
}

std::size_t ZipArchive::size(const std::string& name) const {
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(archive_.get(), name.c_str(), 0, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE) ||
      !(stat.valid & ZIP_STAT_COMP_SIZE))
    fail("no file " + in_quotes(name) + " in the zip archive, though it is needed", "the file is damaged");
  const bool impossible =
      stat.comp_size > content_.size() || stat.size > kMostDeflateRatio * stat.comp_size + kSmallFile;
  if (impossible || stat.size > most_unpacked(content_.size()))
    fail(
        in_quotes(name) + " claims " + std::to_string(stat.size) + " bytes, packed into " +
            std::to_string(stat.comp_size),
        impossible ? "the file is damaged: nothing packs so well" : "pack the file anew without compression");
  return static_cast<std::size_t>(stat.size);
}

std::string ZipArchive::read(const std::string& name, std::size_t size) const {
  if (const std::size_t there = this->size(name); there != size)
    fail(in_quotes(name) + " has " + std::to_string(there) + " bytes; expected " + std::to_string(size),
         "the file is truncated, or its header does not fit the data");
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> entry(zip_fopen(archive_.get(), name.c_str(), 0),
                                                                zip_fclose);
  if (!entry)
    fail("cannot unpack " + in_quotes(name) + ": " + zip_strerror(archive_.get()), "the file is damaged");
  std::string content(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const zip_int64_t got = zip_fread(entry.get(), content.data() + done, size - done);
    if (got <= 0) fail("cannot unpack " + in_quotes(name) + ": damaged data", "the file is damaged");
    done += static_cast<std::size_t>(got);
  }
  // The checksum is compared at the end of the data.
  char beyond;
  if (zip_fread(entry.get(), &beyond, 1) != 0)
    fail(in_quotes(name) + " does not fit its size or its checksum", "the file is damaged");
  return content;
}

}  // namespace scintray::core
