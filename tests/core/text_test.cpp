#include "scintray/core/text.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace scintray;
using namespace scintray::core;

TEST_CASE("A list has its separator between items only") {
  const std::vector<std::string> words{"a", "", "c"};
  CHECK(list_of(words) == "a, , c");
  CHECK(list_of(words, "; ") == "a; ; c");
  CHECK(list_of(std::span(words).first(1)) == "a");
  CHECK(list_of(std::vector<std::string>{}).empty());
  CHECK(list_quoted(words) == "\"a\", \"\", \"c\"");
  CHECK(list_of(std::vector<int>{1, 2}, "+", [](int i) { return std::to_string(i); }) == "1+2");
}

TEST_CASE("A noun has the article of its first letter") {
  CHECK(with_article("angle") == "an angle");
  CHECK(with_article("length") == "a length");
}

TEST_CASE("Texts are compared without the case of letters") {
  CHECK(same_but_case("keV", "KEV"));
  CHECK_FALSE(same_but_case("keV", "ke"));
  CHECK_FALSE(same_but_case("keV", "meV"));
}
