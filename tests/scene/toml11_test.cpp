// Pins what ScintRay takes from toml11 beyond its public interface, for the version in use.
#include "scintray/config/detail/toml11.hpp"

#include <doctest/doctest.h>

#include <sstream>
#include <string>

using namespace scintray;
using namespace scintray::config;
using toml11::Mistake;

namespace {

toml::value parsed(const std::string& text) {
  std::istringstream stream(text);
  return toml::parse(stream, "scene.toml");
}

std::string written(const std::string& text, const toml::value& value) {
  const toml11::Span span = toml11::span_of(value);
  return text.substr(span.offset, span.size);
}

void check_error(const std::string& text, std::size_t line, std::size_t byte_column, Mistake mistake) {
  CAPTURE(text);
  try {
    parsed(text);
    FAIL_CHECK("no syntax error");
  } catch (const toml::exception& error) {
    const toml11::SyntaxError found = toml11::syntax_error(error);
    CHECK(found.line == line);
    CHECK(found.byte_column == byte_column);
    CHECK(found.mistake == mistake);
    CHECK_FALSE(found.message.empty());
    CHECK(found.message.find('\n') == std::string::npos);
    CHECK(found.message.find("toml::") == std::string::npos);
  }
}

}  // namespace

TEST_CASE("the span of a value is what is written of it") {
  const std::string text =
      "whole = 1_000\nhex = 0xff\nnumber = 2.50e3\nyes = true\ndate = 1979-05-27\n"
      "word = \"two µ\"\nlist = [1,\n 2]\ntable = { a = 'b' }\n[part]\nname = \"c\"\n";
  const toml::value document = parsed(text);
  CHECK(written(text, document.at("whole")) == "1_000");
  CHECK(written(text, document.at("hex")) == "0xff");
  CHECK(written(text, document.at("number")) == "2.50e3");
  CHECK(written(text, document.at("yes")) == "true");
  CHECK(written(text, document.at("date")) == "1979-05-27");
  CHECK(written(text, document.at("word")) == "\"two µ\"");
  CHECK(written(text, document.at("list")) == "[1,\n 2]");
  CHECK(written(text, document.at("table")) == "{ a = 'b' }");
  CHECK(written(text, document.at("table").at("a")) == "'b'");
  CHECK(written(text, document.at("part")) == "[part]");
  CHECK(written(text, document.at("part").at("name")) == "\"c\"");
}

TEST_CASE("a value that was made in code has an empty span") {
  const toml11::Span span = toml11::span_of(toml::value(3));
  CHECK(span.offset == 0);
  CHECK(span.size == 0);
}

TEST_CASE("an error about two places has the line of the other one") {
  try {
    parsed("a = 1\n\na = 2\n");
    FAIL_CHECK("no syntax error");
  } catch (const toml::exception& error) {
    CHECK(toml11::syntax_error(error).other_line == 1);
  }
  try {
    parsed("a = @\n");
    FAIL_CHECK("no syntax error");
  } catch (const toml::exception& error) {
    CHECK(toml11::syntax_error(error).other_line == 0);
  }
}

TEST_CASE("a syntax error has its place and its kind") {
  check_error("gap = 2 mm\n", 1, 9, Mistake::more_on_the_line);
  check_error("a = 1\na = 2\n", 2, 5, Mistake::defined_twice);
  check_error("[a]\nx = 1\n[a]\ny = 2\n", 3, 1, Mistake::defined_twice);
  check_error("a = { b = \"µµµ\", b = 2 }\n", 1, 25, Mistake::defined_twice);
  check_error("a = \"abc\n", 1, 5, Mistake::open_string);
  check_error("x = 1\ny 2\n", 2, 2, Mistake::no_equals_sign);
  check_error("a = { x = 1,\n b = 2 }\n", 1, 13, Mistake::bad_key);
  check_error("a = [1,\n2\n b = 3\n", 3, 2, Mistake::open_array);
  check_error("a = 1\nb = \n", 2, 5, Mistake::no_value);
  check_error("a = tru\n", 1, 5, Mistake::bad_value);
  check_error("a = .5\n", 1, 5, Mistake::bad_value);
  check_error("a = [0, x]\n", 1, 9, Mistake::bad_value);
  check_error("a = { x = 1 y = 2 }\n", 1, 13, Mistake::open_table);
  check_error("[a]\nx = 1\n[[a]]\ny = 2\n", 3, 1, Mistake::defined_twice);
  check_error("a = 'abc\"\n", 1, 5, Mistake::open_string);
  check_error("[my part]\n", 1, 1, Mistake::bad_key);
}
