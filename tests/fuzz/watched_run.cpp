#include "watched_run.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <new>

// Memory is watched through the global operator new; the sanitizers bring their own.
#ifndef SCINTRAY_SANITIZED
namespace {
std::size_t largest_request = 0;
}

void* operator new(std::size_t size) {
  largest_request = std::max(largest_request, size);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#else
namespace {
std::size_t largest_request = 0;
}
#endif

namespace scintray::fuzz {

bool watched_run(const Entry& entry, const std::string& content) {
  largest_request = 0;
  bool read = false;
  std::string escaped;
  try {
    read = entry.run(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  } catch (const std::exception& error) {
    escaped = error.what();
  }
  // Once a case has failed there is no use in saying so a thousand times.
  if (!escaped.empty()) FAIL(entry.name << ": " << escaped);
  if (largest_request > entry.bytes_per_byte * content.size() + entry.always_allowed)
    FAIL(entry.name << ": " << largest_request << " bytes asked for, with an input of " << content.size());
  return read;
}

}  // namespace scintray::fuzz
