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
  check_syntax("a = 1\nb = @@\n", "nothing stands after \"b =\"", "value there");
  check_syntax("a = @@\"abc\n", "not closed", "on the same line");
  check_syntax("a = 1\na = @@2\n", {"\"a\"", "twice", "line 1"}, "keep one");
  check_syntax("x = 1\ny@@ 2\n", "no =", "y = 2");
  check_syntax("gap = @@2 mm\n", {"\"2 mm\"", "without quotes"}, "gap = \"2 mm\"");
  check_syntax("a = [1,\n2\n @@b = 3\n", {"opens with [ in line 1", "not closed"}, "]");
  check_syntax("a = [1,\n@@b = 3\n", {"opens with [ in line 1", "not closed"}, "]");
  check_syntax("a = [1 @@2]\n", "without a comma", "commas");
  check_syntax("[a]\nx = 1\n@@[a]\ny = 2\n", {"[a]", "twice", "line 1"}, "[[name]]");
  check_syntax("@@[a]\nx = 1\n[[a]]\ny = 2\n", {"[a]", "single brackets", "line 3"}, "[[a]]");
  check_syntax("[[a]]\nx = 1\n@@[a]\ny = 2\n", {"[a]", "single brackets", "line 1"}, "[[a]]");
  check_syntax("a = { x = 1,@@\n b = 2 }\n", "line 1 goes on", "on one line");
  check_syntax("a = { x = 1, @@}\n", "comma", "remove");
  check_syntax("a = { x = 1 @@y = 2 }\n", "without a comma", "commas");
  check_syntax("a = @@99999999999999999999\n", {"not fit", "64 bits"}, "below");
}

TEST_CASE("values that are none are read as they were meant") {
  check_syntax("a = @@LYSO\n", {"\"LYSO\"", "without quotes"}, "a = \"LYSO\"");
  check_syntax("a = [@@LSO, LYSO]\n", {"\"LSO\"", "without quotes"}, "\"LSO\"");
  check_syntax("a = @@tru\n", "neither true nor false", "a = true");
  check_syntax("a = @@No\n", "neither true nor false", "a = false");
  check_syntax("a = @@0,5\n", "comma in the number", "a = 0.5");
  check_syntax("a = @@.5\n", "number", "a = 0.5");
  check_syntax("a = @@007\n", "number", "a = 7");
  check_syntax("a = @@97 %\n", "without quotes", "a = \"97 %\"");
  check_syntax("a = @@2*mm\n", "without quotes", "a = \"2 mm\"");
  check_syntax("a = @@10*100\n", "calculation", "result");
  check_syntax("a = @@1;\n", "semicolon", "a = 1");
  check_syntax("a = @@1 // one\n", "no comment", "#");
  check_syntax("a = @@\"x\", \"y\"\n", "list without brackets", "a = [\"x\", \"y\"]");
  check_syntax("a = @@(1, 2)\n", "round brackets", "square brackets");
  check_syntax("a = @@\u201cLYSO\u201d\n", "typographic quote", "a = \"LYSO\"");
  check_syntax("a = [0, 0, @@\u22121]\n", "typographic minus", "-1");
  check_syntax("a = @@\"C:\\data\\x.stl\"\n", "backslash", "C:/data/x.stl");
}

TEST_CASE("keys and headers that are none are read as they were meant") {
  check_syntax("a@@: 1\n", "colon", "a = 1");
  check_syntax("@@// one\n", "no comment", "#");
  check_syntax("@@[part\nx = 1\n", "does not close", "[part]");
  check_syntax("@@[[part]\nx = 1\n", "does not close", "[[part]]");
  check_syntax("@@[my part]\nx = 1\n", "blank", "[my_part]");
  check_syntax("max@@ n = 1\n", "blank", "max_n");
  check_syntax("@@<?xml version=\"1.0\"?>\n", "XML", "import");
  check_syntax("@@/gate/world x\n", "macro", "key = value");
  check_syntax("@@]\n", "closes nothing", "remove");
}

TEST_CASE("columns count characters, not bytes") {
  check_syntax("@@µ = 1\n", "character that keys cannot have", "letters");
  check_syntax("a = { b = \"µµµ\", b = @@2 }\n", {"\"b\"", "twice"}, "keep one");
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
