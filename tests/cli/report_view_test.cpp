// The scene in three dimensions on pages of runs, and photon paths recorded in results.
#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/results/results.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

const char* const kMeshScene = R"(
title = "A mesh on a sensor"
ambient = "air"
[[part]]
name = "crystal"
mesh = "crystal.obj"
unit = "mm"
medium = "LSO"
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
photons = 2000
[run]
paths = 30
[[tally]]
type = "ledger"
[[tally]]
type = "irradiance"
name = "at the window"
face = "pmt:+z"
way = "in"
pixel = "0.5 mm"
)";

const char* const kCube = R"(v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 2
v 2 0 2
v 2 2 2
v 0 2 2
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

std::string page_in(const std::filesystem::path& folder) {
  std::ifstream file(folder / "scene.html", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("The page of a run has its scene and recorded paths, and one line where a mesh is not available") {
  const auto folder = scratch_folder("report_view");
  std::ofstream(folder / "scene.toml") << kMeshScene;
  std::ofstream(folder / "crystal.obj") << kCube;
  const Ended run = run_program({"run", "scene.toml", "-q"}, folder);
  REQUIRE_MESSAGE(run.exit_code == cli::kSuccess, run.output);
  CHECK(results::read_paths(folder / "scene.h5", 0).size() == 30);
  const bool draws = contains(page_in(folder), "class=\"view-open\"");
  if (draws) {
    check_contains(page_in(folder), "2 parts and the paths of 30 photons");
    check_contains(page_in(folder), "\"detected by pmt\"");
    for (const char* painted : {"detected, by sensor face", "ledger: returned", "\"n\":\"at the window\""})
      check_contains(page_in(folder), painted);
  } else {
    check_contains(page_in(folder), "built without three.js");
  }

  const Ended bare = run_program({"report", "scene.h5", "--no-view"}, folder);
  REQUIRE_MESSAGE(bare.exit_code == cli::kSuccess, bare.output);
  CHECK_FALSE(contains(page_in(folder), "three dimensions"));
  CHECK(page_in(folder).size() < 700'000);

  std::filesystem::remove(folder / "crystal.obj");
  const Ended missing = run_program({"report", "scene.h5"}, folder);
  REQUIRE_MESSAGE(missing.exit_code == cli::kSuccess, missing.output);
  check_contains(page_in(folder), "The scene is not shown: ");
  CHECK_FALSE(contains(page_in(folder), "view-open\""));
}

TEST_CASE("A scene with overlapping parts is shown with the places of its problems, before they are errors") {
  const auto folder = scratch_folder("view_problems");
  std::ofstream(folder / "scene.toml") << R"(
ambient = "air"
contacts_default = "bonded"
[[part]]
name = "crystal"
box = { low = ["0 mm", "0 mm", "0 mm"], high = ["2 mm", "2 mm", "2 mm"] }
medium = "LSO"
surface = "polished"
[[part]]
name = "intruder"
box = { low = ["1 mm", "1 mm", "1 mm"], high = ["3 mm", "3 mm", "3 mm"] }
medium = "glass"
surface = "polished"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
photons = 10
)";
  const Ended ended = run_program({"view", "scene.toml"}, folder);
  CHECK(ended.exit_code == cli::kBadInput);
  check_contains(ended.output, "intruder");
  std::ifstream file(folder / "scene_view.html");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  if (page.empty()) return;  // built without three.js
  const std::size_t marks = page.find("\"marks\":[{");
  REQUIRE(marks != std::string::npos);
  check_contains(page.substr(marks, 400), "\"p\":[[");
}
