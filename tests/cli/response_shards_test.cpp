// The shards of a response map make the map of one process, bit for bit.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "cli/program.hpp"
#include "cli/program_words.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/same_results.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

/// Two crystals of different media with a sensor each, so that a backward map has two spectra.
const char* const kTwoMedia = R"(
title = "Two crystals"
ambient = "air"
[[part]]
name = "lso"
box = ["2 mm", "2 mm", "5 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "bgo"
box = ["2 mm", "2 mm", "5 mm"]
translate = ["4 mm", "0 mm", "0 mm"]
medium = "BGO"
surface = "polished"
[[part]]
name = "pmt_lso"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "lso", side = "-z" }
sensor = "R6231"
[[part]]
name = "pmt_bgo"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "bgo", side = "-z" }
sensor = "R6231"
[source]
type = "gamma_events"
events = 50
region = { part = "lso" }
energy = "100 keV"
)";

const Words kForward{"--direction", "forward", "--photons", "60", "--pitch", "1 mm", "--delays", "4"};
const Words kBackward{"--direction", "backward", "--channel-photons", "2003",
                      "--pitch",     "1 mm",     "--delays",          "4"};

/// A folder with the scene.
std::filesystem::path map_folder(const std::string& name) {
  const auto folder = scratch_folder("response_shards_" + name);
  std::ofstream(folder / "scene.toml") << kTwoMedia;
  return folder;
}

Words build(const Words& options) { return Words{"response", "build", "scene.toml", "-q"} + options; }

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("The shards of a response map, in any order, make the map of one process to the last bit") {
  for (const Words& direction : {kForward, kBackward}) {
    CAPTURE(direction[1]);
    const auto folder = map_folder("identity_" + direction[1]);
    check_done(build(direction + Words{"-o", "whole.h5", "-t", "1"}), folder);
    // 47: more than the 32 parts of the light of the channels, so that some shards are empty.
    for (const int of : {1, 5, 47}) {
      CAPTURE(of);
      Words parts;
      for (int number = of; number >= 1; number -= 2) parts.push_back(std::to_string(number));
      for (int number = of - 1; number >= 1; number -= 2) parts.push_back(std::to_string(number));
      for (std::string& part : parts) {
        check_done(build(direction + Words{"-o", "map.h5", "--shard", part + "/" + std::to_string(of), "-t",
                                           part.back() == '3' ? "3" : "1"}),
                   folder);
        part = "map." + std::string(std::to_string(of).size() - part.size(), '0') + part + "-of-" +
               std::to_string(of) + ".shard";
        CHECK(std::filesystem::exists(folder / part));
        CHECK_FALSE(std::filesystem::exists(folder / (part + ".journal")));
      }
      const std::string merged = "merged_" + std::to_string(of) + ".h5";
      check_done(Words{"merge", "-q", "-o", merged} + parts, folder);
      check_same_results(folder / "whole.h5", folder / merged, 10);
      CHECK(bytes_of(folder / "whole.h5") == bytes_of(folder / merged));
    }
    check_done({"response", "run", "scene.toml", "merged_5.h5", "-o", "events.h5", "-q", "--no-report"},
               folder);
  }
}

TEST_CASE("merge names the missing shards of a response map, and never makes a map of a part") {
  const auto folder = map_folder("missing");
  for (const std::string number : {"1", "3"})
    check_done(build(kForward + Words{"-o", number + ".h5", "--shard", number + "/4"}), folder);
  const Words merge{"merge", "-q", "-o", "map.h5", "3.3-of-4.shard", "1.1-of-4.shard"};
  check_refused(merge, folder, {"shards 2, 4 of 4 are missing", "no partial response maps"});
  check_refused(merge + Words{"--partial"}, folder, {"shards 2, 4 of 4 are missing"});
  CHECK_FALSE(std::filesystem::exists(folder / "map.h5"));
  check_refused(merge + Words{"3.3-of-4.shard"}, folder, {"3.3-of-4.shard", "are also in"});
}

TEST_CASE("merge refuses shards of another response map, with what differs, and files that are none") {
  const auto folder = map_folder("refused");
  check_done(build(kForward + Words{"-o", "a.h5", "--shard", "1/2"}), folder);
  const Words merge{"merge", "-q", "-o", "map.h5", "a.1-of-2.shard"};
  const auto check_other = [&](const Words& options, const std::string& difference) {
    check_done(build(options + Words{"-o", "b.h5", "--shard", "2/2"}), folder);
    check_refused(merge + Words{"b.2-of-2.shard"}, folder, {"b.2-of-2.shard", difference});
  };
  check_other(kForward + Words{"--seed", "8"}, "the seed is 8, not 1");
  const auto with = [](const std::string& option, const std::string& value) {
    Words words = kForward;
    *(std::find(words.begin(), words.end(), option) + 1) = value;
    return words;
  };
  check_other(with("--photons", "61"), "61 photons from each cell, not 60");
  check_other(kBackward, "2003 photons backward from each channel, not 60 photons from each cell");
  check_other(with("--pitch", "2 mm"), "the cells are 1 x 1 x 3");
  check_other(with("--delays", "5"), "times of flight kept are 5, not 4");
  check_refused(merge + Words{"none.shard"}, folder, {"none.shard", "no such file"});
  check_refused(merge + Words{"scene.toml"}, folder, {"scene.toml", "not a shard of a response map"});
  check_done({"run", "scene.toml", "-q", "--events", "2", "--shard", "1/2", "-o", "run.shard"}, folder);
  check_refused(merge + Words{"run.shard"}, folder, {"run.shard", "not a shard of a response map"});
  check_refused(Words{"merge", "-q", "-o", "scene.toml", "a.1-of-2.shard"}, folder,
                {"scene.toml", "not a response map"});
  std::ofstream(folder / "scene.toml", std::ios::app) << "# another text\n";
  check_other(kForward, "the scene file has another text");
  for (const std::string wrong : {"0/3", "4/3", "2", "a/b"})
    check_refused(build(kForward + Words{"-o", "c.h5", "--shard", wrong}), folder, {"--shard", wrong},
                  cli::kBadUsage);
}

TEST_CASE("A damaged shard of a response map is refused, wherever its damage is") {
  for (const Words& direction : {kForward, kBackward}) {
    CAPTURE(direction[1]);
    const auto folder = map_folder("damaged_" + direction[1]);
    check_done(build(direction + Words{"-o", "a.h5", "--shard", "1/1"}), folder);
    const std::string sound = bytes_of(folder / "a.1-of-1.shard");
    for (std::size_t at = 3; at < sound.size(); at += sound.size() / 13) {
      std::string damaged = sound;
      damaged[at] = static_cast<char>(damaged[at] ^ 16);
      std::ofstream(folder / "bit.shard", std::ios::binary) << damaged;
      check_refused({"merge", "-q", "-o", "map.h5", "bit.shard"}, folder, {"bit.shard"});
      std::ofstream(folder / "cut.shard", std::ios::binary) << sound.substr(0, at);
      check_refused({"merge", "-q", "-o", "map.h5", "cut.shard"}, folder, {"cut.shard"});
    }
    CHECK_FALSE(std::filesystem::exists(folder / "map.h5"));
  }
}

TEST_CASE("Shards of a response map whose files differ are not merged") {
  const auto folder = scratch_folder("response_shards_inputs");
  std::string text = kTwoMedia;
  const std::string box = "box = [\"2 mm\", \"2 mm\", \"5 mm\"]";
  text.replace(text.find(box), box.size(), "mesh = \"crystal.stl\"\nunit = \"mm\"");
  std::ofstream(folder / "scene.toml") << text;
  const auto mesh = folder / "crystal.stl";
  std::filesystem::copy_file(source_file("geometry/crystal_2x2x20.stl"), mesh);
  check_done(build(kForward + Words{"-o", "a.h5", "--shard", "1/2"}), folder);
  // The same triangles in other bytes: the text at the beginning of an STL file.
  std::fstream(mesh, std::ios::in | std::ios::out | std::ios::binary) << "another";
  check_done(build(kForward + Words{"-o", "a.h5", "--shard", "2/2"}), folder);
  check_refused({"merge", "-q", "-o", "map.h5", "a.1-of-2.shard", "a.2-of-2.shard"}, folder,
                {"a.2-of-2.shard", "input files differ", "crystal.stl"});
}

TEST_CASE("A shard of a response map is resumed by its own command only") {
  const auto folder = map_folder("resumed");
  const Words command = build({"--direction", "forward", "--photons", "40000", "--pitch", "1 mm", "-o",
                               "a.h5", "--shard", "2/3", "-t", "1"});
  const auto journal = folder / "a.2-of-3.shard.journal";
  {
    const Program program(command, folder);
    std::error_code none_yet;
    for (int turn = 0; turn < 60'000 && (!std::filesystem::exists(journal, none_yet) ||
                                         std::filesystem::file_size(journal, none_yet) < 4000);
         ++turn)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.signal(SIGTERM);
    CHECK(program.wait().exit_code == cli::kInterrupted);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "a.2-of-3.shard"));
  REQUIRE(std::filesystem::exists(journal));
  check_refused(command, folder, {"a.2-of-3.shard.journal", "--resume", "--restart"});
  std::filesystem::copy_file(journal, folder / "a.1-of-3.shard.journal");
  Words other = command;
  std::replace(other.begin(), other.end(), std::string("2/3"), std::string("1/3"));
  check_refused(other + Words{"--resume"}, folder, {"a.1-of-3.shard.journal", "other work"});
  check_done(command + Words{"--resume"}, folder);
  const std::string resumed = bytes_of(folder / "a.2-of-3.shard");
  check_done(command, folder);
  CHECK(bytes_of(folder / "a.2-of-3.shard") == resumed);
}
