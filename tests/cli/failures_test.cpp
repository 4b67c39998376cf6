#include "scintray/cli/commands.hpp"

#include <doctest/doctest.h>

#include <new>
#include <sstream>
#include <stdexcept>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/cancelled.hpp"
#include "scintray/core/error.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::cli;
using namespace scintray::test;

TEST_CASE("A command that returns is a success and prints nothing") {
  std::ostringstream err;
  CHECK(cli::run_guarded([] {}, err) == cli::kSuccess);
  CHECK(err.str().empty());
}

TEST_CASE("Every problem of an InputError is printed with its place and hint") {
  std::ostringstream err;
  const auto command = [] {
    throw InputError({{{"scene.toml", 3, 7}, "unknown key \"surfce\"", "did you mean \"surface\"?"},
                      {{"scene.toml", 9, 1}, "no source", ""}});
  };
  CHECK(cli::run_guarded(command, err) == cli::kBadInput);
  CHECK(err.str() ==
        "scene.toml:3:7: error: unknown key \"surfce\" [unknown-key]\n  hint: did you mean \"surface\"?\n"
        "scene.toml:9:1: error: no source [input]\n2 problems\n");
}

TEST_CASE("Problems that differ in numbers only share one message, with their lines and a hint for all") {
  std::vector<core::Problem> problems;
  for (int i = 0; i < 60; ++i) {
    const std::string pair =
        "\"crystal[" + std::to_string(i) + "]\" and \"sipm_" + std::to_string(i % 7) + "\"";
    problems.push_back(
        {{"scene.toml", 10 + i, 1}, "faces of " + pair + " are bonded", "between = [" + pair + "]"});
  }
  problems.push_back({{"scene.toml", 3, 1}, "no source", "write one"});
  std::ostringstream err;
  CHECK(cli::run_guarded([&] { throw core::InputError(problems); }, err) == cli::kBadInput);
  const std::string text = err.str();
  check_contains(text, "scene.toml:10:1: error: faces of \"crystal[0]\" and \"sipm_0\" are bonded");
  CHECK_FALSE(contains(text, "crystal[1]"));
  check_contains(text, {"and 59 more of this kind", "at lines 11, 12, 13", "and 51 more"});
  check_contains(text, "for all of them: between = [\"crystal[*]\" and \"sipm_*\"]");
  check_contains(text, "scene.toml:3:1: error: no source");
  check_contains(text, "61 problems of 2 kinds");
  // A few are printed one by one.
  problems.resize(3);
  std::ostringstream few;
  cli::run_guarded([&] { throw core::InputError(problems); }, few);
  check_contains(few.str(), "crystal[2]");
  CHECK_FALSE(contains(few.str(), "more of this kind"));
}

TEST_CASE("A stop by the user is no defect") {
  std::ostringstream err;
  CHECK(cli::run_guarded([] { throw Cancelled("a table was being built"); }, err) == cli::kInterrupted);
  CHECK(err.str() == "stopped: a table was being built\n");
}

TEST_CASE("Failures of the system and defects of the program have exit codes of their own") {
  std::ostringstream err;
  CHECK(cli::run_guarded([] { throw SystemError("disk full"); }, err) == cli::kSystemFailure);
  CHECK(err.str() == "error: disk full [system]\n");
  CHECK(cli::run_guarded([] { throw std::bad_alloc(); }, err) == cli::kSystemFailure);

  err.str("");
  CHECK(cli::run_guarded([] { throw InternalError("photon without a fate"); }, err) == cli::kDefect);
  CHECK(err.str().find("photon without a fate") != std::string::npos);
  CHECK(err.str().find("report it") != std::string::npos);
  CHECK(cli::run_guarded([] { throw std::logic_error("x"); }, err) == cli::kDefect);
  CHECK(cli::run_guarded([] { throw 1; }, err) == cli::kDefect);
}
