// Runs by the processes of mpirun make the results of one process, bit for bit, and lose nothing that was
// finished.
#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/same_results.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

using Words = std::vector<std::string>;

/// Light with a list of photons and a sweep of two points.
const char* const kScene = R"(
title = "A crystal on a sensor"
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "6 mm"]
medium = "LSO"
surface = "polished"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "R6231"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
time = "decay"
photons = 200_000
[run]
photon_list = true
paths = 40
[[sweep]]
key = "part.crystal.surface"
label = "surface"
values = ["polished", "white"]
[surfaces.white]
model = "painted"
reflectance = 0.93
specular_share = 0.1
)";

/// The command that starts `ranks` processes; empty where there is none, with a line that marks the test as
/// skipped.
Words mpirun(int ranks) {
#ifdef SCINTRAY_TESTS_MPIRUN
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  return {SCINTRAY_TESTS_MPIRUN, "--oversubscribe", "-n", std::to_string(ranks)};
#else
  static_cast<void>(ranks);
  std::printf("[skipped] this build is without MPI\n");
  return {};
#endif
}

std::filesystem::path scene_folder(const std::string& name) {
  const auto folder = scratch_folder("mpi_" + name);
  std::ofstream(folder / "scene.toml") << kScene;
  return folder;
}

Words run_into(const std::string& output, const Words& more = {}) {
  Words words{"run", "scene.toml", "--no-report", "-q", "-t", "1", "-o", output};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void check_done(const Ended& ended) {
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kSuccess);
}

}  // namespace

TEST_CASE("1, 2 and 4 ranks make the results of one process") {
  if (mpirun(1).empty()) return;
  const auto folder = scene_folder("bits");
  check_done(run_program(run_into("one.h5", {"--photons", "60000"}), folder));
  for (const int ranks : {1, 2, 4}) {
    CAPTURE(ranks);
    check_done(Program(run_into("ranks.h5", {"--photons", "60000"}), folder, 0, mpirun(ranks)).wait());
    check_same_results(folder / "one.h5", folder / "ranks.h5");
    CHECK_FALSE(std::filesystem::exists(folder / "ranks.h5.checkpoints"));
  }
}

TEST_CASE(
    "A rank that is killed ends the run, and the run is resumed, by other numbers of ranks, to the same "
    "bits") {
  if (mpirun(1).empty()) return;
  const auto folder = scene_folder("killed");
  check_done(run_program(run_into("whole.h5"), folder));
  // Each rank writes its process id by the shell that becomes it; the last one is killed.
  const Words by_shell{"/bin/sh", "-c", "echo $$ > rank$OMPI_COMM_WORLD_RANK.pid; exec \"$0\" \"$@\""};
  Words launcher = mpirun(3);
  launcher.insert(launcher.end(), by_shell.begin(), by_shell.end());
  const auto checkpoint = folder / "out.h5.checkpoints/000003.ranges";
  const Program program(run_into("out.h5", {"--checkpoint-every", "0 s"}), folder, 0, launcher);
  for (int turn = 0; turn < 60'000 && !std::filesystem::exists(checkpoint); ++turn)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  pid_t rank = 0;
  std::ifstream(folder / "rank2.pid") >> rank;
  REQUIRE(rank > 0);
  kill(rank, SIGKILL);
  CHECK(program.wait().exit_code != cli::kSuccess);
  CHECK(std::filesystem::exists(checkpoint));
  check_done(Program(run_into("out.h5", {"--resume"}), folder, 0, mpirun(2)).wait());
  check_same_results(folder / "whole.h5", folder / "out.h5");
  CHECK_FALSE(std::filesystem::exists(folder / "out.h5.checkpoints"));
}

TEST_CASE("Under mpirun errors come once, and other commands are refused") {
  if (mpirun(1).empty()) return;
  const auto folder = scene_folder("errors");
  const Ended missing = Program({"run", "none.toml"}, folder, 0, mpirun(3)).wait();
  CHECK(missing.exit_code == cli::kBadInput);
  const std::string text = "none.toml\" does not exist";
  CHECK(contains(missing.output, text));
  CHECK(missing.output.find(text) == missing.output.rfind(text));
  const Ended check = Program({"check", "scene.toml"}, folder, 0, mpirun(2)).wait();
  CHECK(check.exit_code == cli::kBadUsage);
  CHECK(contains(check.output, "without mpirun"));
}
