#include "scintray/core/byte_size.hpp"

#include <doctest/doctest.h>

using namespace scintray::core;

namespace {

constexpr std::uint64_t kNone = ~std::uint64_t{0};

std::uint64_t bytes_of(const char* text) { return parse_byte_size(text).value_or(kNone); }

}  // namespace

TEST_CASE("sizes are read with their unit, decimal or binary") {
  CHECK(bytes_of("500 MB") == 500'000'000u);
  CHECK(bytes_of("2GiB") == std::uint64_t{2} << 30);
  CHECK(bytes_of("1.5 KiB") == 1536u);
  CHECK(bytes_of("7 B") == 7u);
  CHECK(bytes_of("0") == 0u);
  CHECK(bytes_of("0 GB") == 0u);
  for (const char* wrong : {"", "GB", "5", "-1 GB", "5 gb", "1 GB more", "inf GB", "nan B", "1e30 TB"}) {
    CAPTURE(wrong);
    CHECK(bytes_of(wrong) == kNone);
  }
}

TEST_CASE("sizes are written in the largest unit of which there is one") {
  CHECK(byte_size_text(0) == "0 B");
  CHECK(byte_size_text(1023) == "1023 B");
  CHECK(byte_size_text(1024) == "1.0 KiB");
  CHECK(byte_size_text(1'239'123) == "1.2 MiB");
  CHECK(byte_size_text(std::uint64_t{5000} << 30) == "5000.0 GiB");
}
