#include "scintray/cli/commands.hpp"

#include <doctest/doctest.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>
#include <vector>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/error.hpp"

using namespace scintray;
using namespace scintray::cli;

namespace {

/// `scintray halve NUMBER`: a subcommand that the program does not have.
struct Halved {
  static inline int last = 0;  // where a callback, which returns nothing, leaves its answer
};

void add_halve_command(CLI::App& app) {
  auto number = std::make_shared<int>(0);
  CLI::App* command = app.add_subcommand("halve", "Divide an even number by two");
  command->add_option("NUMBER", *number, "an even number")->required();
  command->callback([number] {
    if (*number % 2 != 0)
      throw core::InputError({{}, std::to_string(*number) + " is not even", "give an even number"});
    Halved::last = *number / 2;
  });
}

/// Exit code of a command line, and what it printed.
struct Run {
  int code = 0;
  std::string out, err;
};

Run run(std::vector<const char*> words) {
  std::vector<AddCommand> available(commands().begin(), commands().end());
  available.push_back(add_halve_command);
  words.insert(words.begin(), "scintray");
  std::ostringstream out, err;
  const int code = run_program(available, static_cast<int>(words.size()), words.data(), out, err);
  return {code, out.str(), err.str()};
}

}  // namespace

TEST_CASE("A subcommand from outside runs beside those of the program") {
  const Run halved = run({"halve", "42"});
  CHECK(halved.code == kSuccess);
  CHECK(halved.err.empty());
  CHECK(Halved::last == 21);
}

TEST_CASE("A subcommand from outside stands in the help, after those of the program") {
  const Run help = run({"--help"});
  CHECK(help.code == kSuccess);
  const std::size_t own = help.out.find("halve");
  REQUIRE(own != std::string::npos);
  CHECK(help.out.find("Divide an even number by two") != std::string::npos);
  CHECK(help.out.find("\n  run ") < own);
  CHECK(help.out.find("\n  fit ") < own);
  CHECK(run({"halve", "--help"}).out.find("an even number") != std::string::npos);
}

TEST_CASE("Failures of a subcommand from outside have the program's exit codes and messages") {
  const Run odd = run({"halve", "41"});
  CHECK(odd.code == kBadInput);
  CHECK(odd.err.find("41 is not even") != std::string::npos);
  CHECK(run({"halve"}).code == kBadUsage);
  CHECK(run({"halve", "many"}).code == kBadUsage);
}

TEST_CASE("A program without the subcommand does not know its name") {
  const std::vector<const char*> words = {"scintray", "halve", "42"};
  std::ostringstream out, err;
  CHECK(run_program(commands(), static_cast<int>(words.size()), words.data(), out, err) == kBadUsage);
}
