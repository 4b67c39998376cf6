#include "scintray/config/detail/toml_mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "scintray/config/detail/text_place.hpp"
#include "scintray/core/error.hpp"

namespace scintray::config {

namespace {

using toml11::Mistake;

constexpr const char* kHowToWrite =
    "a line is key = value: text and quantities in quotes (\"LYSO\", \"2 mm\"), numbers without (0.97), "
    "lists "
    "in brackets ([0, 0, 1]), yes and no as true and false";

/// A [header] that is not well formed.
ExplainedMistake explain_header(const TextPlace& place) {
  const std::string line = place.line();
  const std::size_t at = place.line_begin();
  const std::size_t open = std::min(line.find_first_not_of('['), std::size_t{2});
  const std::size_t close = std::min(line.find(']'), line.size());
  const std::string name = trimmed(line.substr(std::min(open, close), close - std::min(open, close)));
  const auto with = [&](const std::string& inner) {
    return std::string(open, '[') + inner + std::string(open, ']');
  };
  if (line.compare(close, open, std::string(open, ']')) != 0)
    return {at,
            shown(line) + " opens " + std::to_string(open) + " bracket" + (open > 1 ? "s" : "") +
                " and does not close " + (open > 1 ? "both" : "it"),
            "write " + with(name)};
  const std::string after = trimmed(line.substr(std::min(close + open, line.size())));
  if (!after.empty() && after[0] != '#')
    return {at, core::in_quotes(after) + " stands on the line of the header " + with(name),
            after.find_first_not_of(']') == std::string::npos ? "write " + with(name)
                                                              : "write it on a line of its own below"};
  if (name.empty()) return {at, "a header without a name", "write a name between the brackets, as [source]"};
  std::string plain = name;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ' ' || c == '\t'; }, '_');
  while (!plain.empty() && plain.back() == '.') plain.pop_back();
  if (plain != name)
    return {
        at,
        "the header " + with(name) + (name.back() == '.' ? " ends with a dot" : " has a blank in its name"),
        "write " + with(plain)};
  return {at, "the header " + with(name) + " has a character that names cannot have",
          "use letters, digits, _ and -, with dots between the names, as [media.my_glass]"};
}

/// A line whose beginning is no key.
ExplainedMistake explain_key(const TextPlace& place) {
  const std::string line = place.line();
  const std::size_t at = place.offset();
  if (place.bracket() == '{' || place.bracket() == '[') {
    const std::size_t from = place.line_number(*place.open_bracket());
    const std::string rest = place.rest();
    if (place.bracket() == '{' && (rest.empty() || rest[0] == '#'))
      return {at, fmt::format("the {{ ... }} of line {} goes on in the next line", from),
              "write everything from { to } on one line, or as a [header] with a key = value on each line"};
  }
  if (place.open_bracket() && starts_with_any(place.rest(), {":"}))
    return {at, "a colon stands where an = is expected", "write key = value"};
  if (line.empty()) return {at, "the file ends too early", kHowToWrite};
  if (line[0] == '[') return explain_header(place);
  if (place.at_start() && line[0] == '<')
    return {at, "this is an XML file, not a scene (TOML)",
            "for GDML or a mesh use scintray import; a scene is written as in docs/scene_files.md"};
  if (place.at_start() && line[0] == '{') return {at, "this is a JSON file, not a scene (TOML)", kHowToWrite};
  if (starts_with_any(line, {"//", "/*", ";", "%", "!", "--"}))
    return {at, shown(line) + " is no comment here", "a comment begins with #"};
  if (line.size() > 1 && line[0] == '/' && std::isalpha(static_cast<unsigned char>(line[1])) != 0)
    return {at, shown(line) + " is a command of a Geant4 or GATE macro, not a line of a scene", kHowToWrite};
  if (line[0] == ']' || line[0] == '}')
    return {at, fmt::format("a {} that closes nothing", line[0]), "remove it, or open the bracket before it"};
  if (line[0] == '=') return {at, "nothing stands before the =", "write a key there: key = value"};
  const auto equals = line.find('=');
  const std::string key = trimmed(line.substr(0, equals));
  if (equals == std::string::npos) {
    const auto colon = line.find(':');
    if (colon != std::string::npos && colon + 1 < line.size())
      return {at, shown(line) + " has a colon where an = is expected",
              "write " + trimmed(line.substr(0, colon)) + " =" + line.substr(colon + 1)};
    const auto blank = line.find_first_of(" \t");
    return {at, shown(line) + " has no = between a key and its value",
            blank == std::string::npos
                ? "write " + line + " = and a value"
                : "write " + line.substr(0, blank) + " = " + trimmed(line.substr(blank))};
  }
  if (key.find(':') != std::string::npos)
    return {at, core::in_quotes(key) + " has a colon where an = is expected", "write key = value"};
  std::string plain = key;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ' ' || c == '\t'; }, '_');
  if (plain != key)
    return {at, "the key " + core::in_quotes(key) + " has a blank in it", "keys have none: " + plain};
  return {at, "the key " + core::in_quotes(key) + " has a character that keys cannot have",
          "use letters, digits, _ and -"};
}

ExplainedMistake explain_string(const std::string& text, const TextPlace& place) {
  const std::size_t end = std::min(text.find('\n', place.offset()), text.size());
  const std::string written = trimmed(text.substr(place.offset(), end - place.offset()));
  const auto backslash = written.find('\\');
  if (written[0] == '"' && backslash != std::string::npos && written.find('"', 1) != std::string::npos) {
    std::string plain = written;
    std::replace(plain.begin(), plain.end(), '\\', '/');
    return {place.offset(), shown(written) + " has a backslash, which begins a special character",
            "write paths with /, as " + plain};
  }
  return {place.offset(), "the text " + shown(written) + " is not closed",
          std::string("end it on the same line with the quote that opened it: ") + written[0]};
}

ExplainedMistake explain_repeat(const std::string& text, const TextPlace& place, std::size_t other_line) {
  const std::string line = place.line();
  const std::string first = other_line > 0 ? fmt::format(" (line {})", other_line) : std::string();
  if (line[0] != '[')
    return {place.offset(), fmt::format("\"{}\" is given twice{}", place.key(), first),
            "keep one of the two lines"};
  const std::string name =
      trimmed(line.substr(line.find_first_not_of('['), line.find(']') - line.find_first_not_of('[')));
  const bool is_list = starts_with_any(line, {"[["});
  std::size_t other = 0;
  for (std::size_t n = 1; n < other_line && other < text.size(); ++n) other = text.find('\n', other) + 1;
  const bool other_is_header =
      other_line > 0 &&
      text.compare(std::min(text.find_first_not_of(" \t", other), text.size()), 1, "[") == 0;
  const bool other_is_list =
      other_line > 0 &&
      text.compare(std::min(text.find_first_not_of(" \t", other), text.size()), 2, "[[") == 0;
  // Of [x] and [[x]], the one in single brackets is the slip.
  if (is_list != other_is_list && other_is_header)
    return {
        is_list ? other : place.line_begin(),
        fmt::format("[{0}] in single brackets, but line {1} has [[{0}]]", name,
                    is_list ? place.line_number(place.line_begin()) : other_line),
        fmt::format("there may be several, so write [[{}]], in two pairs of brackets, for every one", name)};
  return {place.offset(), fmt::format("[{}] is given twice{}", name, first),
          fmt::format("give each key and each [table] once: put all keys of it below one [{0}]; only tables "
                      "of which there "
                      "are several are written [[name]]",
                      name)};
}

/// A list that continues into a line that begins with a key or header; nothing for another list.
std::optional<ExplainedMistake> explain_unclosed_list(const std::string& text, const TextPlace& place) {
  if (place.bracket() != '[') return std::nullopt;
  const std::size_t open = *place.open_bracket();
  const std::size_t from = place.line_number(open);
  const std::string line = place.line();
  const auto equals = line.find('=');
  const bool new_key = equals != std::string::npos && line.find_first_of("\"'{[") > equals;
  if (place.line_number(place.offset()) == from || !(new_key || line.empty() || line[0] == '['))
    return std::nullopt;
  const std::string first = trimmed(text.substr(open, std::min(text.find('\n', open), text.size()) - open));
  return ExplainedMistake{
      place.offset(), fmt::format("the list that opens with [ in line {} is not closed before here", from),
      "close it with ], as " + first + "]"};
}

ExplainedMistake explain_open_array(const TextPlace& place) {
  return {place.offset(), shown(place.rest()) + " follows an element of a list without a comma",
          "separate the elements with commas and close the list with ]"};
}

ExplainedMistake explain_open_table(const TextPlace& place) {
  const std::string rest = place.rest();
  if (rest.empty() || rest[0] == '#')
    return {place.offset(), "a { is not closed on its line",
            "write everything from { to } on one line, and close it with }"};
  if (rest[0] == '}') return {place.offset(), "a comma stands before the closing }", "remove the comma"};
  return {place.offset(), core::in_quotes(rest) + " follows a value without a comma",
          "separate the keys in { ... } with commas, and close it with }"};
}

/// Offset of the first byte that is not UTF-8; nothing for a text without any.
std::optional<std::size_t> first_not_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC2 ? 2 : 0;
    if (length == 0 || i + length > text.size()) return i;
    for (std::size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return i;
    i += length;
  }
  return std::nullopt;
}

}  // namespace

ExplainedMistake explain_mistake(const std::string& text, std::size_t offset,
                                 const toml11::SyntaxError& error) {
  const TextPlace place(text, offset);
  const auto bad_byte = first_not_utf8(text);
  if (bad_byte && (error.mistake == Mistake::not_utf8 || *bad_byte >= place.line_begin()))
    return {*bad_byte,
            fmt::format("the byte 0x{:02X} is not UTF-8 text", static_cast<unsigned char>(text[*bad_byte])),
            "save the file as UTF-8 in your editor, or write um for the micrometre and deg for the degree"};
  std::optional<ExplainedMistake> found;
  switch (error.mistake) {
    case Mistake::open_string:
      return explain_string(text, place);
    case Mistake::defined_twice:
      return explain_repeat(text, place, error.other_line);
    case Mistake::no_equals_sign:
    case Mistake::bad_key:
      return explain_key(place);
    case Mistake::open_array:
      found = explain_unclosed_list(text, place);
      if (!found) found = explain_value(place);
      return found ? *found : explain_open_array(place);
    case Mistake::open_table:
      if (starts_with_any(place.rest(), {"}"})) return explain_open_table(place);
      found = explain_value(place);
      return found ? *found : explain_open_table(place);
    case Mistake::more_on_the_line:
    case Mistake::no_value:
    case Mistake::bad_value:
    case Mistake::not_utf8:
    case Mistake::other:
      if (place.line()[0] == '[' && !place.open_bracket()) return explain_header(place);
      found = explain_unclosed_list(text, place);
      if (!found) found = explain_value(place);
      if (found) return *found;
  }
  return {offset, shown(place.rest()) + " cannot be read", kHowToWrite};
}

}  // namespace scintray::config
