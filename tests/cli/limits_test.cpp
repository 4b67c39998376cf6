// Runs that have too little memory, or are to count to what no run would end.
#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

TEST_CASE(
    "A run without memory ends with the name of what was made, whatever the limit, and leaves no file") {
#ifdef SCINTRAY_SANITIZED
  return;  // a sanitizer reserves terabytes
#endif
  const auto folder = scratch_folder("limits_memory");
  const std::string scene = source_file("scenes/block_detector.toml").string();
  std::size_t failed = 0;
  // The program alone takes 200 MB, the threads of Embree and the scene 250 MB more.
  for (int megabytes = 240; megabytes <= 400; megabytes += 40) {
    CAPTURE(megabytes);
    const Ended ended =
        Program({"run", scene, "--photons", "100", "-t", "2", "-q", "--no-report", "-o", "out.h5"}, folder, 0,
                {"/bin/sh", "-c", "ulimit -v " + std::to_string(megabytes * 1024) + "; exec \"$0\" \"$@\""})
            .wait();
    CAPTURE(ended.output);
    if (ended.exit_code == cli::kSuccess) continue;
    ++failed;
    CHECK(ended.exit_code == cli::kSystemFailure);
    CHECK(contains(ended.output, "out of memory while"));
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      CHECK_FALSE(contains(entry.path().filename().string(), "out.h5"));
  }
  CHECK(failed > 0);
}

TEST_CASE("Counts that no run would end are refused, in the scene and on the command line") {
  const auto folder = scratch_folder("limits_counts");
  const std::string quickstart = source_file("scenes/quickstart.toml").string();
  for (const std::string option : {"--photons", "--threads", "--events"}) {
    const Ended ended = run_program({"run", quickstart, option, "1000000000000000000"}, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kBadUsage);
    CHECK(contains(ended.output, "1e15"));
  }
  std::ofstream(folder / "scene.toml") << R"(
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "2 mm"]
medium = "LSO"
surface = "polished"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 1_000_000_000_000_000_000
)";
  const Ended ended = run_program({"run", "scene.toml"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kBadInput);
  CHECK(contains(ended.output, "scene.toml:12:"));
  CHECK(contains(ended.output, "at most 1e15"));
}
