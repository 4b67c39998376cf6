/// `scintray new`: scenes to begin with.

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/config/toml_reader.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

TEST_CASE("every template is listed, passes check with all its definitions in use, and detects light") {
  const std::filesystem::path folder = scratch_folder("new_templates");
  const Ended list = run_program({"new"}, folder);
  REQUIRE(list.exit_code == cli::kSuccess);
  std::size_t templates = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_file("scenes/templates"))) {
    const std::string name = entry.path().stem();
    CAPTURE(name);
    ++templates;
    CHECK(contains(list.output, name + " "));
    const Ended written = run_program({"new", name}, folder);
    CHECK(written.exit_code == cli::kSuccess);
    CHECK(contains(written.output, "scintray run " + name + ".toml"));
    const Ended checked = run_program({"check", name + ".toml"}, folder);
    CAPTURE(checked.output);
    CHECK(checked.exit_code == cli::kSuccess);
    CHECK(contains(checked.output, "no errors"));
    CHECK_FALSE(contains(checked.output, "used nowhere"));
    const bool events = name == "array";
    const Ended run = run_program(
        {"run", name + ".toml", events ? "--events" : "--photons", events ? "20" : "2000"}, folder);
    CAPTURE(run.output);
    CHECK(run.exit_code == cli::kSuccess);
    CHECK(contains(run.output, "detected"));
    CHECK(contains(run.output, "Lost photons: 0."));
  }
  CHECK(templates == 5);
}

TEST_CASE("a scene that exists is not replaced, and an unknown template is named with its neighbour") {
  const std::filesystem::path folder = scratch_folder("new_refused");
  CHECK(run_program({"new", "slab", "-o", "mine.toml"}, folder).exit_code == cli::kSuccess);
  const Ended again = run_program({"new", "array", "-o", "mine.toml"}, folder);
  CHECK(again.exit_code == cli::kBadInput);
  CHECK(contains(again.output, "mine.toml"));
  CHECK(contains(config::read_text_file(folder / "mine.toml"), "slab"));
  const Ended unknown = run_program({"new", "arry"}, folder);
  CHECK(unknown.exit_code == cli::kBadInput);
  CHECK(contains(unknown.output, "did you mean array?"));
  CHECK_FALSE(std::filesystem::exists(folder / "arry.toml"));
}
