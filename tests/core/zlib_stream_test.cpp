#include "scintray/core/zlib_stream.hpp"

#include <doctest/doctest.h>

#include <string>

#include "support/deflated.hpp"

using namespace scintray;
using namespace scintray::core;

namespace {

std::string long_text() {
  std::string text;
  for (int i = 0; i < 40'000; ++i) text += std::to_string(i * i % 9973) + ' ';
  return text;
}

std::string unpacked(std::string_view packed, Unpacked& end) {
  std::string text;
  end = unpack(packed, Packing::zlib, [&](std::string_view part) {
    CHECK(part.size() <= 1 << 14);
    text += part;
  });
  return text;
}

}  // namespace

TEST_CASE("A compressed stream decompresses to its input, and its bytes are those of zlib's compress") {
  const std::string text = long_text();
  std::string packed;
  const auto take = [&](std::string_view part) { packed += part; };
  Packer packer;
  packer.add(std::string_view(text).substr(0, 1000), take);
  packer.add({}, take);
  packer.add(std::string_view(text).substr(1000), take);
  packer.finish(take);
  CHECK(packed == test::deflated(text));
  Unpacked end;
  CHECK(unpacked(packed, end) == text);
  CHECK(end.complete);
  CHECK(end.bytes_after == 0);
  CHECK(unpacked(packed + "more", end) == text);
  CHECK(end.complete);
  CHECK(end.bytes_after == 4);
}

TEST_CASE("A truncated, damaged, empty or foreign stream is not complete") {
  const std::string text = long_text(), packed = test::deflated(text);
  Unpacked end{true, 0};
  const std::string start = unpacked(std::string_view(packed).substr(0, packed.size() / 2), end);
  CHECK_FALSE(end.complete);
  CHECK(text.starts_with(start));
  CHECK_FALSE(start.empty());
  std::string damaged = packed;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);  // the check sum
  CHECK(unpacked(damaged, end) == text);
  CHECK_FALSE(end.complete);
  CHECK(unpacked("", end).empty());
  CHECK_FALSE(end.complete);
  CHECK(unpacked("no stream of zlib", end).empty());
  CHECK_FALSE(end.complete);
  CHECK_FALSE(unpack(packed, Packing::gzip, [](std::string_view) {}).complete);
}

TEST_CASE("An empty text is a stream too, and exceptions of the receiver pass through") {
  std::string packed;
  Packer packer;
  packer.finish([&](std::string_view part) { packed += part; });
  Unpacked end;
  CHECK(unpacked(packed, end).empty());
  CHECK(end.complete);
  CHECK_THROWS_AS(unpack(test::deflated("text"), Packing::zlib, [](std::string_view) { throw 1; }), int);
}
