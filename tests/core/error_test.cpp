#include "scintray/core/error.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace scintray;
using namespace scintray::core;

TEST_CASE("A place is written as far as it is known") {
  CHECK(FileLocation{"scene.toml", 3, 7}.text() == "scene.toml:3:7");
  CHECK(FileLocation{"scene.toml", 3, 0}.text() == "scene.toml:3");
  CHECK(FileLocation{"scene.toml", 0, 7}.text() == "scene.toml");
  CHECK(FileLocation{"", 3, 7}.text() == "3:7");
  CHECK(FileLocation{}.text().empty());
}

TEST_CASE("A message has the place, the fault and the hint") {
  const Problem problem{{"a.toml", 2, 5}, "\"2\" has no unit", "add mm"};
  CHECK(problem.text() == "a.toml:2:5: error: \"2\" has no unit\n  hint: add mm");
  CHECK(Problem{{}, "no source", ""}.text() == "error: no source");
  CHECK(std::string(InputError({problem, {{}, "no source", ""}}).what()) ==
        problem.text() + "\nerror: no source");
}

TEST_CASE("Problems are collected and thrown together") {
  Problems problems;
  CHECK_NOTHROW(problems.throw_if_any());
  problems.add({"a.toml", 1, 1}, "first", "mend it");
  problems.add(InputError({{{}, "second", ""}, {{}, "third", ""}}));
  try {
    problems.throw_if_any();
    FAIL("nothing was thrown");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 3);
    CHECK(error.problems()[0].what == "first");
    CHECK(error.problems()[2].what == "third");
  }
}

TEST_CASE("The nearest word is found within a third of the length, at least two edits") {
  CHECK(nearest_word("surfce", {"source", "surface", "sensor"}) == "surface");
  CHECK(nearest_word("medum", {"medium", "mesh"}) == "medium");
  CHECK(nearest_word("ab", {"abcd"}) == "abcd");
  CHECK(nearest_word("ab", {"abcde"}).empty());
  CHECK(nearest_word("kitten", {"sitting"}).empty());  // distance 3, the textbook example
  CHECK(nearest_word("wavelengt", {"wavel", "wavelength"}) == "wavelength");
  CHECK(nearest_word("x", {}).empty());
  // Characters count, not bytes: one dash of a word processor is one character of three bytes.
  CHECK(nearest_word("crystal", {"cr\u2014ystal"}) == "cr\u2014ystal");
  CHECK(nearest_word("\u00b5m", {"\u03bcm"}) == "\u03bcm");
}

TEST_CASE("Case and separators do not make a word another one, and a replaced word is no near one") {
  CHECK(nearest_word("lyso", {"LSO", "LYSO"}) == "LYSO");
  CHECK(nearest_word("LYS0", {"LSO", "LYSO"}) == "LYSO");
  CHECK(nearest_word("S13360-6050", {"S13360_6050VE", "R6231"}) == "S13360_6050VE");
  CHECK(nearest_word("Optical Grease", {"optical_grease", "optical_gel"}) == "optical_grease");
  // What stands behind a colon is a dopant, or the face of a part.
  CHECK(nearest_word("LYSO:Ce", {"LSO", "LYSO", "LYSO_Ca"}) == "LYSO");
  CHECK(nearest_word("LaBr3:Ce", {"CeBr3", "LaBr3"}) == "LaBr3");
  CHECK(nearest_word("NaI:Tl", {"NaI", "NaI_Tl"}) == "NaI_Tl");
  CHECK(nearest_word("kg", {"mm", "m"}).empty());
  CHECK(nearest_word("q", {"x", "y"}).empty());
}
