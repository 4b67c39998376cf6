#include "scintray/scene/name_pattern.hpp"

#include <doctest/doctest.h>

using namespace scintray;

TEST_CASE("A star stands for any characters, everything else for itself") {
  CHECK(matches("block[*]", "block[0,11]"));
  CHECK(matches("block[*,1]", "block[10,1]"));
  CHECK_FALSE(matches("block[*,1]", "block[1,11]"));
  CHECK_FALSE(matches("block[*]", "block_septum_x[0]"));
  CHECK(matches("block*", "block"));
  CHECK(matches("*", "anything"));
  CHECK(matches("*ab*b", "xaabxb"));
  CHECK_FALSE(matches("*ab*b", "xab"));
  CHECK_FALSE(matches("a*a", "a"));
  CHECK(matches("a**c", "abc"));
  CHECK(matches("plain", "plain"));
  CHECK_FALSE(matches("plain", "plainer"));
  CHECK(is_pattern("a*"));
  CHECK_FALSE(is_pattern("a[0,1]"));
  CHECK(literal_length("block[*,1]") == 9);
  CHECK(matching("a*", {"ab", "b", "a"}) == std::vector<std::string>{"ab", "a"});
}
