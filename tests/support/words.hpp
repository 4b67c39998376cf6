#pragma once
/// What the tests ask of texts and of errors.

#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Checks for these words, and shows the text where they are missing.
inline void check_says(const std::string& text, const std::string& words) {
  CAPTURE(text);
  CHECK(contains(text, words));
}

/// Everything an action finds wrong; nothing when it succeeds. Other exceptions pass through.
inline std::vector<Problem> problems_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// The same as text, a problem a line; empty when the action succeeds.
inline std::string complaint_of(const std::function<void()>& action) {
  std::string all;
  for (const Problem& problem : problems_of(action)) all += problem.text() + "\n";
  return all;
}

}  // namespace scintray::test
