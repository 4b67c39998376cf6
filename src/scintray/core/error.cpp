#include "scintray/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <string_view>

#include "scintray/core/text.hpp"

namespace scintray::core {

namespace {

/// The characters of a text in UTF-8, as a reader compares names: letters without their case, and the
/// characters that separate words, or a dopant from its host, as one.
std::u32string folded(std::string_view text) {
  std::u32string characters;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U && !characters.empty())
      characters.back() = characters.back() << 8U | byte;
    else if (c == ' ' || c == '-' || c == '.' || c == ':')
      characters += U'_';
    else
      characters += byte < 0x80U ? static_cast<char32_t>(std::tolower(byte)) : char32_t{byte};
  }
  return characters;
}

/// Insertions, removals and substitutions of a character that make one of the other.
std::size_t edit_distance(const std::u32string& a, const std::u32string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

/// Number of characters at the beginning that both have.
std::size_t common_beginning(const std::string& a, const std::string& b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

}  // namespace

std::string FileLocation::text() const {
  std::string text = file;
  for (const long number : {line, line > 0 ? column : 0}) {
    if (number <= 0) continue;
    if (!text.empty()) text += ':';
    text += std::to_string(number);
  }
  return text;
}

std::string Problem::text() const {
  const std::string place = where.text();
  std::string text = place.empty() ? "error: " + what : place + ": error: " + what;
  if (!hint.empty()) text += "\n  hint: " + hint;
  return text;
}

InputError::InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

InputError::InputError(std::vector<Problem> problems)
    : Error(list_of(problems, "\n", [](const Problem& problem) { return problem.text(); })),
      problems_(std::move(problems)) {}

void Problems::add(FileLocation where, std::string what, std::string hint,
                   std::vector<std::array<double, 3>> places_mm) {
  list_.push_back({std::move(where), std::move(what), std::move(hint), std::move(places_mm)});
}

void Problems::add(Problem problem) { list_.push_back(std::move(problem)); }

void Problems::add(const InputError& error) {
  list_.insert(list_.end(), error.problems().begin(), error.problems().end());
}

void Problems::throw_if_any() {
  if (!list_.empty()) throw InputError(std::move(list_));
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  const std::u32string wanted = folded(word);
  const std::size_t length = wanted.size(), limit = std::max<std::size_t>(2, length / 3);
  std::string best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::u32string known = folded(candidate);
    if (known.size() > length + limit || known.size() + limit < length) continue;
    const std::size_t distance = edit_distance(wanted, known);
    // All of a short word replaced is another word.
    if (distance > limit || distance >= std::max(length, known.size())) continue;
    const bool nearer =
        distance < best_distance ||
        (distance == best_distance && common_beginning(word, candidate) > common_beginning(word, best));
    if (!nearer) continue;
    best_distance = distance;
    best = candidate;
  }
  // Of LYSO:Ce the name is LYSO, unless the whole is a name, as NaI:Tl is.
  const std::size_t colon = word.find(':');
  if (colon == std::string::npos || best_distance == 0) return best;
  const std::u32string before = folded(std::string_view(word).substr(0, colon));
  const auto host = std::find_if(candidates.begin(), candidates.end(),
                                 [&](const std::string& candidate) { return folded(candidate) == before; });
  return host == candidates.end() ? best : *host;
}

InputError unknown_name(const FileLocation& where, const std::string& kind, const std::string& wanted,
                        const std::vector<std::string>& names) {
  constexpr std::size_t kMostNamed = 30;
  std::string list = list_of(std::span(names).first(std::min(names.size(), kMostNamed)));
  if (names.size() > kMostNamed) list += " and " + std::to_string(names.size() - kMostNamed) + " more";
  const std::string near = nearest_word(wanted, names);
  return InputError({where, "no " + kind + " is called \"" + wanted + "\"",
                     (near.empty() ? "" : "did you mean \"" + near + "\"? ") + ("there are: " + list)});
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMost = 80;
  std::string result = "\"";
  for (std::size_t k = 0; k < text.size() && k < kMost; ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    // A micro sign or degree sign in Latin-1 stands alone; in UTF-8 a lead byte comes before it.
    const bool tail = byte >= 0x80 && byte < 0xC0;
    const bool follows = k > 0 && static_cast<unsigned char>(text[k - 1]) >= 0x80;
    const bool leads =
        byte >= 0xC2 && k + 1 < text.size() && (static_cast<unsigned char>(text[k + 1]) & 0xC0) == 0x80;
    const bool printable = (byte >= 0x20 && byte < 0x7F) || (tail && follows) || leads;
    result += printable ? text[k] : '?';
  }
  return result + (text.size() > kMost ? "...\"" : "\"");
}

}  // namespace scintray::core
