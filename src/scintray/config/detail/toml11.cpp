#include "scintray/config/detail/toml11.hpp"

#include <charconv>
#include <sstream>

namespace scintray::config::toml11 {

namespace {

Mistake mistake_in(const std::string& message) {
  const auto has = [&](const char* words) { return message.find(words) != std::string::npos; };
  if (has("expected newline")) return Mistake::more_on_the_line;
  for (const char* words : {"defined twice", "already exists", "already defined", "cannot be defined",
                            "conflicts with", "collides", "neither table"})
    if (has(words)) return Mistake::defined_twice;
  for (const char* words : {"valid string", "valid literal string", "valid multiline string"})
    if (has(words)) return Mistake::open_string;
  if (has("utf8") || has("UTF-8")) return Mistake::not_utf8;
  if (has("separator `=`")) return Mistake::no_equals_sign;
  if (has("valid key") || has("invalid key") || has("character in key") || has("empty key"))
    return Mistake::bad_key;
  if (has("array separator")) return Mistake::open_array;
  for (const char* words : {"table separator", "curly brace", "should be `}`"})
    if (has(words)) return Mistake::open_table;
  if (has("missing value") || has("got nothing")) return Mistake::no_value;
  for (const char* words :
       {"unknown value", "valid value", "bad float", "bad integer", "not an integer", "not a boolean"})
    if (has(words)) return Mistake::bad_value;
  return Mistake::other;
}

/// The first line of a drawing without the name of the function that failed: "[error] toml::function:
/// message".
std::string message_of(std::string line) {
  if (line.rfind("[error] ", 0) == 0) line.erase(0, 8);
  for (const char* prefix : {"toml::", "parse_"})
    if (line.rfind(prefix, 0) == 0) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) line.erase(0, colon + 2);
    }
  return line;
}

}  // namespace

// The public location() counts the lines before every value anew, so that the time to read a scene would grow
// with the square of its length; the region that it counts in holds the offset.
Span span_of(const toml::value& value) {
  const auto* region = dynamic_cast<const toml::detail::region*>(toml::detail::get_region(value));
  if (region == nullptr) return {};
  return {static_cast<std::size_t>(region->first() - region->begin()), region->size()};
}

// The drawing: "[error] toml::function: message\n --> file\n   |\n 3 | line\n   |   ^--- comment". The last
// caret marks the error; the public location() is the start of the value.
SyntaxError syntax_error(const toml::exception& error) {
  SyntaxError result{error.location().line(), error.location().column(), 0, {}, Mistake::other};
  bool placed = false;
  std::istringstream drawing(error.what());
  std::string line;
  std::getline(drawing, line);
  result.message = message_of(line);
  std::string comment;
  std::size_t number = 0;
  while (std::getline(drawing, line)) {
    const auto bar = line.find(" | ");
    if (bar == std::string::npos) continue;
    const auto digit = line.find_first_not_of(' ');
    if (digit < bar && std::from_chars(line.data() + digit, line.data() + bar, number).ec == std::errc{})
      continue;
    const auto caret = line.find_first_not_of(' ', bar + 3);
    if (number == 0 || caret == std::string::npos || (line[caret] != '^' && line[caret] != '~')) continue;
    result.other_line = placed ? result.line : 0;
    placed = true;
    result.line = number;
    result.byte_column = caret - bar - 2;
    const auto words = line.find_first_not_of("^~- ", caret);
    comment = words == std::string::npos ? "" : line.substr(words);
    number = 0;
  }
  if (comment == "here") comment.clear();
  if (!comment.empty())
    result.message = result.message.empty() ? comment : result.message + " (" + comment + ")";
  result.mistake = mistake_in(result.message);
  return result;
}

}  // namespace scintray::config::toml11
