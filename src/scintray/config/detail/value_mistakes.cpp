// Mistakes within a value: quotes, units, decimal commas, look-alike characters.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "scintray/config/detail/text_place.hpp"
#include "scintray/config/detail/toml_mistakes.hpp"
#include "scintray/core/error.hpp"

namespace scintray::config {

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

/// A number at the beginning of a text, and what follows it.
struct LeadingNumber {
  double value = 0.0;
  std::string written, rest;
};

std::optional<LeadingNumber> leading_number(const std::string& text) {
  const std::size_t sign = !text.empty() && text[0] == '+' ? 1 : 0;
  LeadingNumber number;
  const auto [end, status] = std::from_chars(text.data() + sign, text.data() + text.size(), number.value);
  if (status != std::errc{} || !(is_digit(text[sign]) || text[sign] == '-' || text[sign] == '.'))
    return std::nullopt;
  number.written = text.substr(0, static_cast<std::size_t>(end - text.data()));
  number.rest = trimmed(text.substr(number.written.size()));
  return number;
}

/// Characters that look like plain ones: pasted from a formatted document.
struct Lookalike {
  const char* typed;
  const char* name;
  const char* plain;
};
constexpr Lookalike kLookalikes[] = {{"\u201c", "a typographic quote", "\""},
                                     {"\u201d", "a typographic quote", "\""},
                                     {"\u201e", "a typographic quote", "\""},
                                     {"\u2018", "a typographic quote", "'"},
                                     {"\u2019", "a typographic quote", "'"},
                                     {"\u00ab", "a typographic quote", "\""},
                                     {"\u00bb", "a typographic quote", "\""},
                                     {"\u2212", "a typographic minus sign", "-"},
                                     {"\u2013", "a dash", "-"},
                                     {"\u00a0", "a blank that does not break", " "},
                                     {"\u00d7", "a multiplication sign", "*"}};

std::optional<ExplainedMistake> explain_lookalike(const TextPlace& place) {
  std::string plain = place.item();
  const Lookalike* found = nullptr;
  for (const Lookalike& known : kLookalikes)
    for (std::size_t at = plain.find(known.typed); at != std::string::npos; at = plain.find(known.typed)) {
      plain.replace(at, std::string(known.typed).size(), known.plain);
      if (!found) found = &known;
    }
  if (!found) return std::nullopt;
  return ExplainedMistake{place.item_offset(),
                          fmt::format("{} holds {} ({}), as from a formatted document", shown(place.item()),
                                      found->name, found->typed),
                          "type plain characters: " + place.with_value(plain)};
}

/// What follows a complete value on its line, or in its list.
ExplainedMistake explain_rest(const TextPlace& place, const std::string& value, const std::string& rest) {
  const std::size_t at = place.item_offset();
  if (place.open_bracket() && rest[0] != ']' && rest[0] != '}')
    return {place.offset(), shown(rest) + " follows " + value + " without a comma",
            rest[0] == ';' ? "separate the elements with commas, not semicolons"
                           : "separate the elements with commas"};
  if (rest[0] == ';') return {at, "the line ends with a semicolon", "remove it: " + place.with_value(value)};
  if (starts_with_any(rest, {"//", "/*", "!", "--"}))
    return {at, shown(rest) + " is no comment here", "a comment begins with #"};
  if (rest[0] == ']' || rest[0] == '}')
    return {at, fmt::format("a {} that closes nothing stands after {}", rest[0], value), "remove it"};
  if (rest == ",") return {at, "the line ends with a comma", "remove it: " + place.with_value(value)};
  if (rest[0] == ',')
    return {at, shown(place.item()) + " is a list without brackets",
            "write " + place.with_value("[" + place.item() + "]")};
  if (rest.find('=') != std::string::npos)
    return {at, shown(rest) + " stands on the same line after " + value, "write one key = value a line"};
  return {at, shown(rest) + " stands after the value " + value + ", where the line must end",
          "write one key = value a line, and a quantity with its unit in one pair of quotes, as \"2 mm\""};
}

bool is_unit_like(const std::string& text) {
  return !text.empty() && (is_letter(text[0]) || text[0] == '%' || !is_ascii(text[0])) &&
         text.find_first_of("=,;\"'[]{}()") == std::string::npos;
}

ExplainedMistake explain_number(const TextPlace& place, const LeadingNumber& number) {
  const std::size_t at = place.item_offset();
  const std::string& rest = number.rest;
  if (rest.empty())
    return {at, "the number " + place.item() + " is not written as a number is here",
            fmt::format("write {}: digits on both sides of the point, and no zeros before the first digit",
                        place.with_value(fmt::format("{}", number.value)))};
  const std::string unit = trimmed(rest[0] == '*' ? rest.substr(1) : rest);
  if (is_unit_like(unit) && unit != "e" && unit != "E")
    return {at, shown(place.item()) + " is a number with a unit, but stands without quotes",
            "write " + place.with_value("\"" + number.written + " " + unit + "\"")};
  if (rest.size() > 1 && rest[0] == ',' && is_digit(rest[1]) && !place.open_bracket() &&
      std::count(rest.begin(), rest.end(), ',') == 1) {
    const auto more = leading_number(rest.substr(1));
    std::string point = number.written;
    std::erase(point, '.');  // 1.000,5
    point += "." + rest.substr(1);
    return {at, shown(place.item()) + " has a comma in the number",
            "write a point: " + place.with_value(more && !more->rest.empty() ? "\"" + point + "\"" : point)};
  }
  if (rest[0] == '*' || rest[0] == '^' || (rest[0] == '/' && rest.size() > 1 && rest[1] != '/') ||
      (rest[0] == '+' || rest[0] == '-'))
    return {at, shown(place.item()) + " is a calculation, but a number is expected", "write its result"};
  if (rest[0] == '_' || rest[0] == '.' || unit == "e" || unit == "E")
    return {at, "the number " + place.item() + " is not written as a number is here",
            "write it as 1000, 1_000, 0.5 or 1.5e-3"};
  return explain_rest(place, number.written, rest);
}

std::optional<std::string> meant_boolean(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* yes : {"true", "yes", "on", "tru", "t"})
    if (word == yes) return "true";
  for (const char* no : {"false", "no", "off", "fals", "f"})
    if (word == no) return "false";
  return std::nullopt;
}

ExplainedMistake explain_word(const TextPlace& place) {
  const std::string& item = place.item();
  if (const auto boolean = meant_boolean(item))
    return {place.item_offset(), item + " stands without quotes and is neither true nor false",
            "write " + place.with_value(*boolean) +
                " (small letters, no quotes), or in quotes where it is a "
                "name: " +
                place.with_value("\"" + item + "\"")};
  const auto end = item.find_first_of("\"'=;");
  const std::string word = trimmed(item.substr(0, end));
  return {place.item_offset(), "the word " + core::in_quotes(word) + " stands without quotes",
          "write names and other text in quotes: " + place.with_value("\"" + word + "\"")};
}

}  // namespace

std::optional<ExplainedMistake> explain_value(const TextPlace& place) {
  const std::string& item = place.item();
  const std::size_t at = place.item_offset();
  if (const auto found = explain_lookalike(place)) return found;
  if (item.empty()) {
    if (place.key().empty() || place.bracket() == '[') return std::nullopt;
    return ExplainedMistake{at, "nothing stands after \"" + place.key() + " =\"",
                            "write a value there, or remove the line"};
  }
  if (const auto number = leading_number(item)) {
    const bool sound = number->rest.empty() && item.find_first_of(".eE_") == std::string::npos &&
                       (item[0] != '0' || item == "0");
    return sound ? std::nullopt : std::optional(explain_number(place, *number));
  }
  if (item[0] == '"' || item[0] == '\'') {
    const std::size_t end = skip_string(item, 0);
    const std::string rest = trimmed(item.substr(std::min(end, item.size())));
    if (rest.empty()) return std::nullopt;
    return explain_rest(place, item.substr(0, end), rest);
  }
  if (item[0] == '(')
    return ExplainedMistake{at, "the value stands in round brackets",
                            "write a list in square brackets, as " + place.with_value("[1, 2, 3]")};
  if (item[0] == '=')
    return ExplainedMistake{at, "two equals signs",
                            "write one: " + place.with_value(trimmed(item.substr(1)))};
  if (item[0] == ']' || item[0] == '[') {
    const std::size_t close = item.find_last_of(']');
    const std::string rest = close == std::string::npos ? "" : trimmed(item.substr(close + 1));
    return rest.empty() ? std::nullopt : std::optional(explain_rest(place, "[...]", rest));
  }
  if (is_letter(item[0]) || item[0] == '_' || !is_ascii(item[0])) return explain_word(place);
  return std::nullopt;
}

}  // namespace scintray::config
