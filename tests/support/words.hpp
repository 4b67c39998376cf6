#pragma once
/// What the tests check of texts and of errors.

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// `text` with the first occurrence of `old` replaced, for texts that repeat their words.
inline std::string first_replaced(std::string text, const std::string& old, const std::string& by) {
  const auto at = text.find(old);
  REQUIRE_MESSAGE(at != std::string::npos, "not in the text: " << old);
  return text.replace(at, old.size(), by);
}

/// `text` with the one occurrence of `old` replaced.
inline std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const auto at = text.find(old);
  REQUIRE_MESSAGE((at == std::string::npos || text.find(old, at + 1) == std::string::npos),
                  "twice in the text: " << old);
  return first_replaced(std::move(text), old, by);
}

/// What one line of a message must hold, in any order: the names, numbers and keys that its reader acts on,
/// and the words that name the kind of problem. The wording between them is free.
class Fragments {
 public:
  Fragments(const char* only) : parts_{only} {}
  Fragments(std::string only) : parts_{std::move(only)} {}
  Fragments(std::initializer_list<std::string> parts) : parts_(parts) {}

  bool all_in_one_line(const std::string& text) const {
    if (parts_.size() == 1) return contains(text, parts_.front());
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (std::all_of(parts_.begin(), parts_.end(), [&](const auto& part) { return contains(line, part); }))
        return true;
    return false;
  }
  std::string text() const {
    std::string all;
    for (const std::string& part : parts_) all += (all.empty() ? "" : " ... ") + part;
    return all;
  }

 private:
  std::vector<std::string> parts_;
};

/// Checks for these fragments in one line, and shows the text where they are missing.
inline void check_contains(const std::string& text, const Fragments& fragments) {
  CAPTURE(text);
  CAPTURE(fragments.text());
  CHECK(fragments.all_in_one_line(text));
}

/// Everything an action finds wrong; nothing when it succeeds. Other exceptions pass through.
inline std::vector<core::Problem> problems_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    return error.problems();
  }
  return {};
}

/// The same as text, a problem a line; empty when the action succeeds.
inline std::string complaint_of(const std::function<void()>& action) {
  std::string all;
  for (const core::Problem& problem : problems_of(action)) all += problem.text() + "\n";
  return all;
}

}  // namespace scintray::test
