#pragma once
/// What every entry requires of a reader and of its messages.

#include <stdexcept>

#include "scintray/core/error.hpp"

namespace scintray::fuzz {

inline void require(bool good, const char* what) {
  if (!good) throw std::logic_error(what);
}

/// A complaint has problems, each with its place and words.
inline void require_words(const core::InputError& error) {
  require(!error.problems().empty(), "an error without problems");
  for (const core::Problem& problem : error.problems())
    require(problem.where.file == "fuzz" && !problem.what.empty(), "an error without place or words");
}

}  // namespace scintray::fuzz
