#include "scintray/core/pattern.hpp"

#include <doctest/doctest.h>

using namespace scintray;
using namespace scintray::core;

TEST_CASE("A star stands for any characters, everything else for itself") {
  CHECK(matches_pattern("block[*]", "block[0,11]"));
  CHECK(matches_pattern("block[*,1]", "block[10,1]"));
  CHECK_FALSE(matches_pattern("block[*,1]", "block[1,11]"));
  CHECK_FALSE(matches_pattern("block[*]", "block_septum_x[0]"));
  CHECK(matches_pattern("block*", "block"));
  CHECK(matches_pattern("*", "anything"));
  CHECK(matches_pattern("*ab*b", "xaabxb"));
  CHECK_FALSE(matches_pattern("*ab*b", "xab"));
  CHECK_FALSE(matches_pattern("a*a", "a"));
  CHECK(matches_pattern("a**c", "abc"));
  CHECK(matches_pattern("plain", "plain"));
  CHECK_FALSE(matches_pattern("plain", "plainer"));
  CHECK(is_pattern("a*"));
  CHECK_FALSE(is_pattern("a[0,1]"));
  CHECK(literal_length("block[*,1]") == 9);
  CHECK(matching("a*", {"ab", "b", "a"}) == std::vector<std::string>{"ab", "a"});
}
