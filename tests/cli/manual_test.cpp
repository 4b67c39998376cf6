/// `scintray manual` and `scintray completion`: all commands, as their help has them.

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/config/toml_reader.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

TEST_CASE("every command has a manual page with its options, which groff reads without a warning") {
  const std::filesystem::path folder = scratch_folder("manual");
  const Ended written = run_program({"manual", "pages"}, folder);
  REQUIRE(written.exit_code == cli::kSuccess);
  const std::string run = config::read_text_file(folder / "pages/scintray-run.1");
  CHECK(contains(run, "\\-\\-threads"));
  CHECK(contains(run, "SCENE"));
  CHECK(std::filesystem::exists(folder / "pages/scintray-table-build.1"));
  CHECK(contains(config::read_text_file(folder / "pages/scintray.1"), "scintray\\-run"));
  if (std::system("command -v groff >/dev/null 2>&1") != 0) {
    MESSAGE("skipped: there is no groff");
    return;
  }
  std::size_t pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "pages")) {
    CAPTURE(entry.path().string());
    const std::string log = (folder / "groff.txt").string();
    const std::string read = "groff -man -Tascii -ww " + entry.path().string() + " 2>" + log + " >/dev/null";
    CHECK(std::system(read.c_str()) == 0);
    CHECK(config::read_text_file(log).empty());
    ++pages;
  }
  CHECK(pages > 25);
}

TEST_CASE("bash completes commands and options") {
  const std::filesystem::path folder = scratch_folder("completion");
  const Ended printed = run_program({"completion", "bash"}, folder);
  REQUIRE(printed.exit_code == cli::kSuccess);
  std::ofstream(folder / "scintray.bash") << printed.output;
  const auto completed = [&](const std::string& words, int at) {
    const std::string script = "cd " + folder.string() + " && source scintray.bash && COMP_WORDS=(" + words +
                               ") COMP_CWORD=" + std::to_string(at) +
                               " && { _scintray || true; } && echo ${COMPREPLY[@]} > found";
    REQUIRE(std::system(("bash -c '" + script + "'").c_str()) == 0);
    return config::read_text_file(folder / "found");
  };
  CHECK(completed("scintray ru", 1) == "run\n");
  CHECK(contains(completed("scintray run --thr", 2), "--threads"));
  CHECK(completed("scintray table bu", 2) == "build\n");
  CHECK(contains(completed("scintray table build --ray", 3), "--rays"));
  CHECK(completed("scintray run scene.to", 2) == "\n");  // files are the shell's own affair
  for (const std::string shell : {"zsh", "fish"}) {
    const Ended other = run_program({"completion", shell}, folder);
    CHECK(other.exit_code == cli::kSuccess);
    CHECK(contains(other.output, "threads"));
  }
}

TEST_CASE("the page of commands has a section for each, with its options and examples") {
  const std::filesystem::path folder = scratch_folder("manual_markdown");
  REQUIRE(run_program({"manual", "pages", "--markdown"}, folder).exit_code == cli::kSuccess);
  const std::string page = config::read_text_file(folder / "pages/commands.md");
  for (const char* part : {"## scintray run\n", "### scintray table build\n", "`-t, --threads", "--resume"})
    CHECK(contains(page, part));
}
