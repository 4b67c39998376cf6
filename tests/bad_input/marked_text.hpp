#pragma once
/// Bad inputs in which the place of the expected problem is marked.

#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "support/words.hpp"

namespace scintray::test {

/// A text without its mark "@@", and where the mark stood (columns count characters).
struct MarkedText {
  std::string text;
  long line = 0;
  long column = 0;

  explicit MarkedText(const std::string& marked) {
    const auto at = marked.find("@@");
    text = at == std::string::npos ? marked : marked.substr(0, at) + marked.substr(at + 2);
    if (at == std::string::npos) return;
    line = column = 1;
    for (const char c : marked.substr(0, at)) {
      if (c == '\n') {
        ++line;
        column = 1;
      } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
        ++column;
      }
    }
  }
};

/// Checks that exactly one problem was found, with these fragments in its message and hint, at the mark.
inline void check_one_problem(const MarkedText& input, const std::vector<core::Problem>& found,
                              const Fragments& what, const Fragments& hint) {
  INFO("input:\n" << input.text);
  std::string all;
  for (const core::Problem& problem : found) all += problem.text() + "\n";
  INFO("problems:\n" << all);
  REQUIRE(found.size() == 1);
  check_contains(found[0].what, what);
  check_contains(found[0].hint, hint);
  CHECK(found[0].where.line == input.line);
  CHECK(found[0].where.column == input.column);
}

}  // namespace scintray::test
