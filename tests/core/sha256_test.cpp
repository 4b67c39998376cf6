#include "scintray/core/sha256.hpp"

#include <doctest/doctest.h>

using namespace scintray::core;

TEST_CASE("SHA-256 of the standard's messages") {
  // FIPS 180-4 as verified by NIST's example values: "abc", the message of 448 bits, and none.
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1'000'000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 does not depend on the pieces in which the bytes come") {
  std::string text;
  for (int k = 0; k < 300; ++k) text += static_cast<char>(k * 7);
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const std::string message = text.substr(0, length);
    Sha256 pieces;
    for (std::size_t at = 0; at < length; at += 1 + at % 70) pieces.add(message.substr(at, 1 + at % 70));
    CHECK(pieces.hex() == sha256(message));
  }
}
