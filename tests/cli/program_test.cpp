#include <doctest/doctest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/version.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;

namespace {

struct Answer {
  int exit_code = -1;
  std::string output;
};

Answer run_program(const std::string& arguments) {
  const std::string command = "'" + test::program_file().string() + "' " + arguments + " 2>&1";
  Answer answer;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    answer.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) answer.exit_code = WEXITSTATUS(status);
  return answer;
}

}  // namespace

TEST_CASE("--version prints the release and succeeds") {
  const Answer answer = run_program("--version");
  CHECK(answer.exit_code == cli::kSuccess);
  CHECK(answer.output.rfind("scintray " + release(), 0) == 0);
}

TEST_CASE("--help succeeds, a wrong command line is bad usage and shows the help") {
  CHECK(run_program("--help").exit_code == cli::kSuccess);
  const Answer nothing = run_program("");
  CHECK(nothing.exit_code == cli::kBadUsage);
  CHECK(nothing.output.find("Usage: scintray") != std::string::npos);
  CHECK(run_program("frobnicate").exit_code == cli::kBadUsage);
}

TEST_CASE("a command or option with a slip names the one that is meant") {
  const auto refusal = [](const std::string& arguments) {
    const Answer answer = run_program(arguments);
    CHECK(answer.exit_code == cli::kBadUsage);
    return answer.output;
  };
  test::check_contains(refusal("runn scene.toml"), {"no command \"runn\""});
  test::check_contains(refusal("runn scene.toml"), {"did you mean run?"});
  test::check_contains(refusal("map descibe a.gsf"), {"did you mean describe?"});
  test::check_contains(refusal("run scene.toml --photns 5"), {"did you mean --photons?"});
  test::check_contains(refusal("frobnicate"), {"scintray --help"});
}

TEST_CASE("a count of zero is refused in words") {
  const Answer answer = run_program("run scene.toml -t 0");
  CHECK(answer.exit_code == cli::kBadUsage);
  test::check_contains(answer.output, {"--threads", "\"0\" is not a number above 0"});
  CHECK(answer.output.find("00000000") == std::string::npos);
}
