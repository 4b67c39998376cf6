#pragma once
/// Command lines put together from lists of words, and how they have to end.

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/words.hpp"

namespace scintray::test {

using Words = std::vector<std::string>;

inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline void check_done(const Ended& ended) {
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kSuccess);
}

inline void check_done(const Words& words, const std::filesystem::path& folder) {
  check_done(run_program(words, folder));
}

inline void check_refused(const Words& words, const std::filesystem::path& folder, const Words& message,
                          int code = cli::kBadInput) {
  const Ended ended = run_program(words, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == code);
  for (const std::string& part : message) CHECK(contains(ended.output, part));
}

}  // namespace scintray::test
