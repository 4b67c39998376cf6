#pragma once
/// Zip archives in memory.

#include <zip.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace scintray::test {

/// An archive of (name, content), without compression unless `packed`.
inline std::string zipped(const std::vector<std::pair<std::string, std::string>>& entries,
                          bool packed = false) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_t* archive = zip_open_from_source(target, ZIP_CREATE | ZIP_TRUNCATE, &error);
  if (!archive) throw std::runtime_error("cannot make a zip archive");
  zip_source_keep(target);
  for (const auto& [name, content] : entries) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE);
    if (index < 0) throw std::runtime_error("cannot add to a zip archive");
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index),
                             packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 9);
  }
  if (zip_close(archive) != 0) throw std::runtime_error("cannot write a zip archive");
  zip_source_open(target);
  zip_source_seek(target, 0, SEEK_END);
  std::string content(static_cast<std::size_t>(zip_source_tell(target)), '\0');
  zip_source_seek(target, 0, SEEK_SET);
  zip_source_read(target, content.data(), content.size());
  zip_source_close(target);
  zip_source_free(target);
  return content;
}

}  // namespace scintray::test
