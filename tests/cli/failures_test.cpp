#include "scintray/cli/commands.hpp"

#include <doctest/doctest.h>

#include <new>
#include <sstream>
#include <stdexcept>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/cancelled.hpp"
#include "scintray/core/error.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::cli;

TEST_CASE("A command that returns gives success and prints nothing") {
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
        "scene.toml:3:7: error: unknown key \"surfce\"\n  hint: did you mean \"surface\"?\n"
        "scene.toml:9:1: error: no source\n2 problems\n");
}

TEST_CASE("A stop that the user asked for is no defect") {
  std::ostringstream err;
  CHECK(cli::run_guarded([] { throw Cancelled("a table was being built"); }, err) == cli::kInterrupted);
  CHECK(err.str() == "stopped: a table was being built\n");
}

TEST_CASE("The machine's refusals and our own defects have exit codes of their own") {
  std::ostringstream err;
  CHECK(cli::run_guarded([] { throw SystemError("disk full"); }, err) == cli::kSystemFailure);
  CHECK(err.str() == "error: disk full\n");
  CHECK(cli::run_guarded([] { throw std::bad_alloc(); }, err) == cli::kSystemFailure);

  err.str("");
  CHECK(cli::run_guarded([] { throw InternalError("photon without a fate"); }, err) == cli::kDefect);
  CHECK(err.str().find("photon without a fate") != std::string::npos);
  CHECK(err.str().find("report it") != std::string::npos);
  CHECK(cli::run_guarded([] { throw std::logic_error("x"); }, err) == cli::kDefect);
  CHECK(cli::run_guarded([] { throw 1; }, err) == cli::kDefect);
}
