#include <utility>

#include "cli/dark_crystal.hpp"
#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/results/results.hpp"
#include "support/shared.hpp"
#include "support/small_crystal.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::results;
using namespace scintray::test;

namespace {

/// A crystal on a sensor; all light is detected, so a list of photons has one row each.
std::string scene_text(std::uint64_t photons, bool list) {
  return R"(
title = "A crystal on a sensor"
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "2 mm"]
medium = "glass"
surface = "white"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
[[part]]
name = "sensor"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
medium = "glass"
sensor = "ideal"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = )" +
         std::to_string(photons) + R"(
[run]
photon_list = )" +
         (list ? "true" : "false") + R"(
[surfaces.white]
model = "painted"
reflectance = 1.0
specular_share = 0.0
)";
}

std::filesystem::path folder_with(const std::string& name, const std::string& text) {
  const auto folder = scratch_folder("run_" + name);
  std::ofstream(folder / "scene.toml") << text;
  return folder;
}

}  // namespace

TEST_CASE("run writes results and a report, prints where they are, and is quiet about progress in a pipe") {
  const auto folder = folder_with("whole", scene_text(20'000, true));
  const Ended ended = run_program({"run", "scene.toml"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kSuccess);
  CHECK(contains(ended.output, "scene.h5"));
  CHECK(contains(ended.output, "scene.html"));
  CHECK_FALSE(contains(ended.output, "\r"));
  CHECK_FALSE(contains(ended.output, "\033"));
  const RunResult result = read_results(folder / "scene.h5");
  CHECK(result.complete());
  CHECK(result.points.at(0).emitted == 20'000);
  CHECK(result.points.at(0).lost == 0);
  const auto listed = read_photons(folder / "scene.h5", 0, 100'000);
  CHECK(listed.size() == result.points.at(0).count(Fate::detected));
}

TEST_CASE("Photons propagated at once change no result, and are as many as the processor has lanes") {
  const auto folder = folder_with("lanes", scene_text(5'000, true));
  std::vector<float> first;
  for (const int width : core::lane_widths()) {
    CAPTURE(width);
    const Ended ended =
        run_program({"run", "scene.toml", "--no-report", "--lane-width", std::to_string(width)}, folder);
    CHECK(ended.exit_code == cli::kSuccess);
    std::vector<float> times;
    for (const DetectedPhoton& photon : read_photons(folder / "scene.h5", 0, 5'000))
      times.push_back(photon.time_ns);
    REQUIRE(!times.empty());
    if (first.empty()) first = times;
    CHECK(times == first);
  }
  const Ended refused = run_program({"run", "scene.toml", "--lane-width", "3"}, folder);
  CHECK(refused.exit_code == cli::kBadUsage);
  CHECK(contains(refused.output, "--lane-width: \"3\" is no number of lanes that this processor has: 1"));
}

TEST_CASE("Ctrl-C keeps what was traced, marks it partial, and exits with 130") {
  const auto folder = folder_with("interrupted", scene_text(2'000'000'000, false));
  const Program program({"run", "scene.toml"}, folder);
  std::this_thread::sleep_for(std::chrono::seconds(3));
  program.signal(SIGINT);
  const Ended ended = program.wait();
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kInterrupted);
  CHECK(contains(ended.output, "partial"));
  const RunResult result = read_results(folder / "scene.h5");
  CHECK_FALSE(result.complete());
  CHECK(result.points.at(0).emitted > 0);
  CHECK(result.points.at(0).emitted < 2'000'000'000);
  CHECK(read_results_status(folder / "scene.h5").reason == "stopped by the user");
}

TEST_CASE("A full disk ends the run with a message and leaves no file that looks whole") {
  const auto folder = folder_with("full", scene_text(400'000, true));
  const Ended ended = run_program({"run", "scene.toml", "--no-report"}, folder, 2'000'000);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kSystemFailure);
  CHECK(contains(ended.output, "scene.h5"));
  CHECK_FALSE(std::filesystem::exists(folder / "scene.h5"));
}

TEST_CASE("Memory stays under 200 MB, with a list of photons too, which streams to disk") {
  // A photon of the list takes 60 bytes and more in memory: three million would be 180 MB by themselves.
  for (const bool list : {false, true}) {
    const auto folder = folder_with(list ? "memory_list" : "memory", scene_text(3'000'000, list));
    const Ended ended = run_program({"run", "scene.toml", "--no-report"}, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kSuccess);
    MESSAGE("peak memory " << ended.peak_kib / 1024 << " MiB, list " << list);
    CHECK(ended.peak_kib < 200'000'000 / 1024);
  }
}

TEST_CASE("check describes a scene, and lists every mistake with its place") {
  const auto folder = folder_with("check", scene_text(1'000, false));
  const Ended good = run_program({"check", "scene.toml"}, folder);
  CAPTURE(good.output);
  CHECK(good.exit_code == cli::kSuccess);
  for (const std::string part : {"crystal:exit", "volume", "interfaces", "accelerators", "no errors"})
    CHECK(contains(good.output, part));

  std::string text = scene_text(1'000, false);
  text.replace(text.find("medium = \"glass\""), 16, "medium = \"glas\" ");
  text.replace(text.find("\"420 nm\""), 8, "420     ");
  std::ofstream(folder / "scene.toml") << text;
  const Ended bad = run_program({"check", "scene.toml"}, folder);
  CAPTURE(bad.output);
  CHECK(bad.exit_code == cli::kBadInput);
  CHECK(contains(bad.output, "scene.toml:"));
}

TEST_CASE("Parts that overlap are refused with both names") {
  std::string text = scene_text(1'000, false);
  text.insert(
      text.find("[source]"),
      "[[part]]\nname = \"intruder\"\nbox = [\"1 mm\", \"1 mm\", \"5 mm\"]\nmedium = \"glass\"\nsurface = "
      "\"polished\"\ntranslate = [\"0 mm\", \"0 mm\", \"1 mm\"]\n");
  const auto folder = folder_with("overlap", text);
  const Ended ended = run_program({"check", "scene.toml"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kBadInput);
  CHECK(contains(ended.output, "intruder"));
  CHECK(contains(ended.output, "crystal"));
}

TEST_CASE("replay follows a photon to its end") {
  const auto folder = folder_with("replay", scene_text(1'000, false));
  const Ended ended = run_program({"replay", "scene.toml", "--event", "0", "--photon", "3"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kSuccess);
  CHECK(contains(ended.output, "detected by"));
}

TEST_CASE("reweight prints light under other optics and writes a table, and refuses what it cannot do") {
  std::string text = scene_text(5'000, false);
  text.replace(text.find("reflectance = 1.0"), 17, "reflectance = 0.9");
  text.replace(text.find("photon_list = false"), 19, "photon_history = true");
  const auto folder = folder_with("reweight", text);
  CHECK(run_program({"run", "scene.toml", "--no-report"}, folder).exit_code == cli::kSuccess);
  const auto did = [&](std::vector<std::string> arguments, int code, const std::string& words) {
    arguments.insert(arguments.begin(), {"reweight", "scene.h5"});
    const Ended ended = run_program(arguments, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == code);
    CHECK(contains(ended.output, words));
  };
  did({"--reflectance", "white=0.8,95 %", "-o", "table.csv"}, cli::kSuccess,
      "reflectance of white 0.95: detected");
  did({"--absorption-length", "glass=100,200 mm,none", "--reflectance", "white=x0.9"}, cli::kSuccess,
      "absorption length of glass none, reflectance of white x 0.9: detected");
  // What the fractions leave out stands beside them.
  did({"--reflectance", "white=0.8"}, cli::kSuccess, "The detected fraction ");
  did({"--reflectance", "white=0.8", "--json"}, cli::kSuccess, "\"not_included\": [");
  did({"--reflectance", "whit=0.8"}, cli::kBadInput, "did you mean \"white\"");
  did({"--reflectance", "white"}, cli::kBadUsage, "no name before");
  did({"--reflectance", "white=x0.9,0.8"}, cli::kBadUsage, "mixed");
  did({"--absorption-length", "glass=100"}, cli::kBadUsage, "has no unit");
  did({}, cli::kBadUsage, "no property to change");
  std::ifstream table(folder / "table.csv");
  std::string line;
  int lines = 0;
  for (; std::getline(table, line); ++lines) {
    if (lines == 2) CHECK(line.starts_with("# The detected fraction "));
    if (lines == 3) CHECK(line.starts_with("point,reflectance of white,traced_fraction"));
  }
  CHECK(lines == 6);
  std::ofstream(folder / "scene.toml") << scene_text(1'000, false);
  CHECK(run_program({"run", "scene.toml", "--no-report"}, folder).exit_code == cli::kSuccess);
  did({"--reflectance", "white=0.8"}, cli::kBadInput, "photon_history = true");
}

TEST_CASE("replay prints the start of a photon, and takes the results file of a run") {
  const auto folder = folder_with("replay_result", scene_text(1'000, true));
  REQUIRE(run_program({"run", "scene.toml", "--seed", "5", "-q"}, folder).exit_code == cli::kSuccess);
  const std::vector<std::string> photon{"--event", "0", "--photon", "3"};
  const auto replay = [&](std::vector<std::string> words) {
    words.insert(words.end(), photon.begin(), photon.end());
    const Ended ended = run_program(words, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kSuccess);
    return ended.output;
  };
  const std::string from_result = replay({"replay", "scene.h5"});
  check_contains(from_result, {"     0 ", "emitted in crystal", "420.00 nm"});
  check_contains(from_result, {"detected by"});
  CHECK(from_result == replay({"replay", "scene.toml", "--seed", "5"}));
  CHECK(from_result != replay({"replay", "scene.toml"}));
}

TEST_CASE("A signal ends a command that still builds its scene, with 130 and no file") {
  // Two balls of half a million triangles, of which one is cut from the other.
  std::string balls;
  for (const char* more : {"translate = [\"50 mm\", \"0 mm\", \"0 mm\"]\n",
                           "translate = [\"53 mm\", \"0.1 mm\", \"0.2 mm\"]\npriority = 1\n"})
    balls += "[[part]]\nname = \"ball" + std::to_string(balls.size()) +
             "\"\nsphere = { radius = \"5 mm\", subdivisions = 150 }\nmedium = \"glass\"\nsurface = "
             "\"polished\"\n" +
             more;
  const DarkCrystal crystal("run_stopped_early");
  crystal.write(balls + kDarkFit, kRows);
  std::ofstream(crystal.folder / "events.toml") << kSmallCrystal << balls;
  const std::pair<int, std::vector<std::string>> commands[] = {
      {SIGTERM, {"check", "scene.toml"}},
      {SIGINT, {"run", "scene.toml"}},
      {SIGHUP, {"response", "build", "events.toml", "-o", "map.h5"}},
      {SIGTERM, {"fit", "scene.toml"}}};
  for (const auto& command : commands) {
    CAPTURE(command.second.front());
    const Program program(command.second, crystal.folder);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    program.await_handler(command.first);
    program.signal(command.first);
    const Ended ended = program.wait();
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kInterrupted);
    check_contains(ended.output, "stopped");
    for (const auto& entry : std::filesystem::directory_iterator(crystal.folder)) {
      const std::string name = entry.path().filename().string();
      CAPTURE(name);
      CHECK_FALSE(name.ends_with(".h5"));  // an empty .NAME.h5.lock stays
    }
  }
}

TEST_CASE("A pipe that nobody reads costs nothing of a run: results and page are written") {
  const auto folder = folder_with("closed_pipe", scene_text(1'000, false));
  Program({"run", "scene.toml"}, folder, 0,
          {"/bin/sh", "-c", "{ sleep 1; \"$0\" \"$@\"; echo $? > code.txt; } | true"})
      .wait();
  int code = -1;
  std::ifstream(folder / "code.txt") >> code;
  CHECK(code == cli::kSuccess);
  CHECK(read_results(folder / "scene.h5").complete());
  CHECK(std::filesystem::exists(folder / "scene.html"));
}

TEST_CASE("results are not written under the name of another format") {
  const auto folder = folder_with("names", scene_text(10, false));
  const Ended ended = run_program({"run", "scene.toml", "-o", "out.csv"}, folder);
  CHECK(ended.exit_code == cli::kBadInput);
  check_contains(ended.output, {"HDF5", "\".csv\""});
  check_contains(ended.output, {"out.h5"});
  CHECK_FALSE(std::filesystem::exists(folder / "out.csv"));
}

TEST_CASE("run prints the notes and warnings of check") {
  std::string text = scene_text(10, false);
  const std::string touch = "place = { touch = \"crystal\", side = \"-z\" }";
  text.replace(text.find(touch), touch.size(),
               "place = { touch = \"crystal\", side = \"-z\", gap = \"0.00015 mm\" }");
  text += "[surfaces.never_used]\nmodel = \"smooth\"\n";
  const auto folder = folder_with("notes", text);
  for (const char* command : {"check", "run"}) {
    const Ended ended = run_program({command, "scene.toml"}, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kSuccess);
    check_contains(ended.output, {"note", "[surfaces.never_used]"});
    check_contains(ended.output, {"warning", "\"crystal\"", "\"sensor\"", "0.00015 mm apart"});
  }
}

TEST_CASE("check prints the size of parts and of the scene, and the normals of faces") {
  const auto folder = folder_with("sizes", scene_text(10, false));
  const Ended ended = run_program({"check", "scene.toml"}, folder);
  check_contains(ended.output, {"crystal ", "2 x 2 x 2"});
  check_contains(ended.output, {"bounding box", "(-1, -1, -1) to (1, 1, 2) mm", "2 x 2 x 3 mm"});
  check_contains(ended.output, {"crystal:exit", "(0, 0, -1)"});
  check_contains(ended.output, {"crystal:other", "not flat"});
  check_contains(run_program({"check", "scene.toml", "--all"}, folder).output,
                 {"crystal:exit", "(0, 0, -1), (0, 0, 0)"});
}

TEST_CASE("outputs never replace what is of another kind, nor one another") {
  const auto folder = folder_with("replaced", scene_text(1000, false));
  for (const char* name : {"a", "b"}) {
    std::filesystem::create_directory(folder / name);
    std::filesystem::copy(folder / "scene.toml", folder / name / "scene.toml");
  }
  const Ended both = run_program({"run", "a/scene.toml", "b/scene.toml"}, folder);
  CHECK(both.exit_code == cli::kBadUsage);
  check_contains(both.output, {"a/scene.toml", "b/scene.toml", "scene.h5"});
  CHECK_FALSE(std::filesystem::exists(folder / "scene.h5"));
  REQUIRE(run_program({"run", "scene.toml", "-q"}, folder).exit_code == cli::kSuccess);
  const auto size = std::filesystem::file_size(folder / "scene.h5");
  const Ended page = run_program({"report", "scene.h5", "-o", "scene.toml"}, folder);
  CHECK(page.exit_code == cli::kBadInput);
  check_contains(page.output, {"scene.toml", "a TOML file", "not written over"});
  const Ended device = run_program({"report", "scene.h5", "-o", "/dev/null"}, folder);
  CHECK(device.exit_code == cli::kBadInput);
  CHECK_FALSE(std::filesystem::is_regular_file("/dev/null"));
  const Ended table = run_program({"table", "stack", "polished", "--inside", "LSO", "--outside", "air",
                                   "--wavelength", "420 nm", "--rays", "1000", "-o", "scene.h5"},
                                  folder);
  CHECK(table.exit_code != 0);
  CHECK(std::filesystem::file_size(folder / "scene.h5") == size);
}

TEST_CASE("a result with a flipped bit is refused by every command that reads results") {
  const auto folder = folder_with("flipped", scene_text(1000, true));
  REQUIRE(run_program({"run", "scene.toml", "-q"}, folder).exit_code == cli::kSuccess);
  {
    std::fstream file(folder / "scene.h5", std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(1200);
    const int byte = file.get();
    file.seekp(1200);
    file.put(static_cast<char>(byte ^ 4));
  }
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"report", "scene.h5"},
        {"report", "--text", "scene.h5"},
        {"analyze", "scene.h5"},
        {"reweight", "scene.h5", "--reflectance", "white=0.9"},
        {"replay", "scene.h5", "--event", "0", "--photon", "0"},
        {"response", "run", "scene.toml", "scene.h5", "-o", "out.h5"},
        {"table", "show", "scene.h5"}}) {
    const Ended ended = run_program(command, folder);
    CAPTURE(command[0]);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kBadInput);
  }
}
