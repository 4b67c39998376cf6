#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "scintray/cli/count_option.hpp"
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
  test::check_contains(refusal("table build map.gsf --rayz 5"), {"scintray table build has no option"});
  test::check_contains(refusal("table build map.gsf --rayz 5"), {"scintray table build --help"});
}

TEST_CASE("a count of zero is refused in words") {
  const Answer answer = run_program("run scene.toml -t 0");
  CHECK(answer.exit_code == cli::kBadUsage);
  test::check_contains(answer.output, {"--threads", "\"0\" is not a number above 0"});
  CHECK(answer.output.find("00000000") == std::string::npos);
}

TEST_CASE("a count may have underscores or an exponent, and is whole") {
  const auto converted = [](std::string text) {
    const std::string problem = cli::whole_count()(text);
    return problem.empty() ? text : problem;
  };
  CHECK(converted("7") == "7");
  CHECK(converted("400_000") == "400000");
  CHECK(converted("4e5") == "400000");
  CHECK(converted("1.5e3") == "1500");
  CHECK(converted("1e15") == "1000000000000000");
  for (const char* wrong : {"1.5", "0", "-3", "1e16", "1e", "_5", "5_", "1__0", "many"})
    CHECK(converted(wrong).find('"') == 0);
  const Answer answer = run_program("run scene.toml --photons 1.5");
  CHECK(answer.exit_code == cli::kBadUsage);
  test::check_contains(answer.output, {"--photons", "\"1.5\" is not a whole number"});
}

TEST_CASE(
    "a wrong command line gets two lines, what is wrong and where its use is shown, without words of a "
    "parser") {
  for (const char* arguments :
       {"run", "run scene.toml --photons", "run scene.toml --photons abc", "report a.h5 --json --text",
        "goniometer polished --angle \"45 deg\" --side above", "map describe",
        "table build map.gsf --rays"}) {
    const Answer answer = run_program(arguments);
    CAPTURE(answer.output);
    CHECK(answer.exit_code == cli::kBadUsage);
    CHECK(answer.output.rfind("error: ", 0) == 0);
    CHECK(std::count(answer.output.begin(), answer.output.end(), '\n') == 2);
    test::check_contains(answer.output, "[usage]\n");
    test::check_contains(answer.output, {"  hint: scintray ", "--help"});
    for (const char* jargon : {"Error:", "Mismatch", "UINT", "TEXT"})
      CHECK(answer.output.find(jargon) == std::string::npos);
  }
  test::check_contains(run_program("run scene.toml --photons").output,
                       {"--photons is not followed by a value"});
}
