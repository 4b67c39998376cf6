#pragma once
/// Text as one zlib stream (RFC 1950). Users link ZLIB::ZLIB.

#include <zlib.h>

#include <string>

namespace scintray::test {

inline std::string deflated(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
           text.size());
  packed.resize(size);
  return packed;
}

}  // namespace scintray::test
