// Malformed TOML: one clean message at the right place.
#include "bad_input/marked_text.hpp"
#include "scintray/config/toml_reader.hpp"

using namespace scintray;
using namespace scintray::config;
using namespace scintray::test;

namespace {

void check_syntax(const std::string& marked, const Fragments& what, const Fragments& hint) {
  const MarkedText input(marked);
  const auto found = problems_of([&] { parse_toml(input.text, "scene.toml"); });
  check_one_problem(input, found, what, hint);
  REQUIRE(found.size() == 1);
  CHECK(found[0].where.file == "scene.toml");
  CHECK_FALSE(contains(found[0].what, "\n"));
  CHECK_FALSE(contains(found[0].what, "toml::"));
}

}  // namespace

TEST_CASE("malformed TOML is reported at its line and column") {
  check_syntax("a = 1\nb = @@\n", "missing value", "value after the =");
  check_syntax("a = @@\"abc\n", "not a valid string", "close the string");
  check_syntax("a = 1\na = @@2\n", "already exists", "once");
  check_syntax("x = 1\ny@@ 2\n", "missing key-value separator", "key = value");
  check_syntax("gap = 2 @@mm\n", "expected newline", "\"2 mm\"");
  check_syntax("a = [1,\n2\n @@b = 3\n", "array separator", "commas");
  check_syntax("[a]\nx = 1\n@@[a]\ny = 2\n", "defined twice", "[[name]]");
  check_syntax("a = @@tru\n", {"not valid TOML", "boolean"}, "toml.io");
  check_syntax("a = { x = 1,@@\n b = 2 }\n", "not a valid key", "one line");
  check_syntax("a = @@99999999999999999999\n", {"not fit", "64 bits"}, "below");
}

TEST_CASE("columns count characters, not bytes") {
  check_syntax("@@µ = 1\n", "not valid TOML", "");
  check_syntax("a = { b = \"µµµ\", b = @@2 }\n", "already exists", "once");
}

TEST_CASE("a file that is not text is refused") {
  const std::string zero("a = 1\nb = \0\n", 12);
  const auto found = problems_of([&] { parse_toml(zero, "scene.toml"); });
  REQUIRE(found.size() == 1);
  CHECK(contains(found[0].what, "not a text file"));
  CHECK(found[0].where.line == 2);
  CHECK(found[0].where.column == 5);
  CHECK(problems_of([&] { parse_toml("a = \"\xff\xfe\"\n", "scene.toml"); }).size() == 1);
}

TEST_CASE("nesting without end is an error, not a crash") {
  for (const std::string& unit : {std::string("["), std::string("{a="), std::string("a.")}) {
    std::string text = unit == "a." ? "" : "a = ";
    for (int i = 0; i < 200000; ++i) text += unit;
    const auto found = problems_of([&] { parse_toml(text, "scene.toml"); });
    REQUIRE(found.size() == 1);
    check_contains(found[0].what, {"nested", "100 deep"});
  }
}

TEST_CASE("a byte order mark and Windows line ends change nothing") {
  const TomlNodePtr plain = parse_toml("a = 1\nb = \"x\"\n", "scene.toml");
  const TomlNodePtr windows = parse_toml(
      "\xEF\xBB\xBF"
      "a = 1\r\nb = \"x\"\r\n",
      "scene.toml");
  REQUIRE(windows->items.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(windows->items[i].key == plain->items[i].key);
    CHECK(windows->items[i].text == plain->items[i].text);
    CHECK(windows->items[i].where.text() == plain->items[i].where.text());
    CHECK(windows->items[i].key_where.text() == plain->items[i].key_where.text());
  }
}

TEST_CASE("a missing file and a folder are named") {
  const auto missing = problems_of([] { parse_toml_file("no/such/scene.toml"); });
  REQUIRE(missing.size() == 1);
  CHECK(contains(missing[0].what, "\"no/such/scene.toml\" does not exist"));
  const auto folder = problems_of([] { parse_toml_file("."); });
  REQUIRE(folder.size() == 1);
  CHECK(contains(folder[0].what, "is a folder"));
}
