// Shards, checkpoints and resumed runs make the results of one uninterrupted process, bit for bit.
#include <random>
#include <set>

#include "cli/dark_crystal.hpp"
#include "cli/program.hpp"
#include "cli/program_words.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/results/results.hpp"
#include "support/same_results.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

/// A scene and the options that make it short.
struct ShortScene {
  std::string name;  ///< of the test's folder
  std::string file;
  Words options;
};

Ended run_short(const ShortScene& scene, const Words& more, const std::filesystem::path& folder) {
  return run_program(Words{"run", scene.file, "--no-report", "-q"} + scene.options + more, folder);
}

/// Light with a list of photons, histories, wavelength shifting, and tallies of counts and of lengths.
const char* const kPhotonScene = R"(
title = "A crystal on a sensor"
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "6 mm"]
medium = "LSO"
surface = "white"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "R6231"
[surfaces.white]
model = "painted"
reflectance = 0.93
specular_share = 0.1
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
time = "decay"
photons = 30_500
photons_per_event = 100
[run]
photon_list = true
photon_history = true
paths = 40
[[tally]]
type = "count"
name = "path"
at = "detected"
score = "path"
axes = [{ variable = "time", from = "0 ns", to = "200 ns", bins = 20 }]
[[tally]]
type = "exit_angle"
face = "crystal:other"
[[bench]]
title = "polished"
surfaces = ["polished"]
inside = "LSO"
outside = ["air"]
wavelength = "420 nm"
incidence = ["0 deg", "40 deg"]
rays = 2000
)";

/// Events with electronics, waveforms and n-th photons.
const char* const kEventScene = R"(
title = "Events"
ambient = "air"
[[part]]
name = "crystal"
box = ["3 mm", "3 mm", "6 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt"
box = ["3 mm", "3 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "R6231"
[source]
type = "gamma_events"
events = 90
region = { part = "crystal" }
energy = "60 keV"
[readout]
period = "0.5 ns"
before = "5 ns"
window = "100 ns"
shaping = { order = 1, time_constant = "5 ns" }
threshold = 3
pulses = true
photon_order = [1, 5, 20]
[run]
paths = 40
)";

std::filesystem::path scene_folder(const std::string& name, const std::string& text) {
  const auto folder = scratch_folder("scaling_" + name);
  std::ofstream(folder / "scene.toml") << text;
  return folder;
}

/// Two scenes that have all that results can hold, and shipped ones with few photons.
std::vector<ShortScene> all_scenes() {
  std::vector<ShortScene> scenes{{"photons", "scene.toml", {}}, {"events", "scene.toml", {}}};
  for (const char* name : {"quickstart", "monolithic_slab"})
    scenes.push_back(
        {name, source_file("scenes/" + std::string(name) + ".toml").string(), {"--photons", "2600"}});
  return scenes;
}

std::filesystem::path folder_of(const ShortScene& scene, const std::string& purpose) {
  return scene_folder(purpose + "_" + scene.name, scene.name == "events" ? kEventScene : kPhotonScene);
}

/// Names in a folder, hidden ones included.
Words names_in(const std::filesystem::path& folder) {
  Words names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

}  // namespace

TEST_CASE("One thread, seven threads and five shards in any order make the same results, in all scenes") {
  for (const ShortScene& scene : all_scenes()) {
    CAPTURE(scene.name);
    const auto folder = folder_of(scene, "shards");
    // Two runs make their surface tables, by one thread and by seven; the shards share a third one.
    check_done(run_short(scene, {"-o", "one.h5", "-t", "1"}, folder));
    check_done(run_short(scene, {"-o", "seven.h5", "-t", "7"}, folder));
    check_same_results(folder / "one.h5", folder / "seven.h5");
    const WithTablesOfThisRun tables;
    Words parts;
    for (const std::string shard : {"4", "1", "5", "3", "2"}) {
      parts.push_back(shard + ".shard");
      check_done(run_short(scene, {"--shard", shard + "/5", "-o", parts.back(), "-t", shard}, folder));
    }
    check_done(run_program(Words{"merge", "-o", "merged.h5", "--no-report", "-q"} + parts, folder));
    check_same_results(folder / "one.h5", folder / "merged.h5");
    const Words names = names_in(folder);
    for (const std::string& name : names) CHECK_FALSE(contains(name, "checkpoints"));
    for (const std::string& name : names) CHECK_FALSE(contains(name, "unfinished"));
    for (const std::string& name : names) CHECK_FALSE(contains(name, "lock"));
  }
}

namespace {

/// The scene of photons with enough blocks to be stopped several times.
const ShortScene kLong{"long", "scene.toml", {"--photons", "200000"}};
const Words kOften{"--checkpoint-every", "0 s"};

/// Starts a run, and sends it a signal once it has written `checkpoints` more.
Ended stop_run(const ShortScene& scene, const Words& more, const std::filesystem::path& folder, int signal) {
  const auto count = [&] {
    std::error_code error;
    std::size_t files = 0;
    for (std::filesystem::directory_iterator entry(folder / "out.h5.checkpoints", error), end;
         !error && entry != end; entry.increment(error))
      files += entry->path().filename().string().starts_with('0') ? 1 : 0;
    return files;
  };
  const std::size_t before = count();
  const Program program(
      Words{"run", scene.file, "--no-report", "-q", "-o", "out.h5"} + scene.options + kOften + more, folder);
  for (int turn = 0; turn < 60'000 && count() < before + 3; ++turn)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  program.signal(signal);
  return program.wait();
}

void replace_in(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::ifstream in(file);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  REQUIRE(contains(text, from));
  text.replace(text.find(from), from.size(), to);
  std::ofstream(file) << text;
}

}  // namespace

TEST_CASE("A run that is killed, ended by signals, and resumed makes the results of one that was not") {
  ShortScene events{"long_events", "scene.toml", {"--events", "400"}};
  for (const ShortScene& scene : {kLong, events}) {
    CAPTURE(scene.name);
    const auto folder =
        scene_folder("killed_" + scene.name, scene.name == "long" ? kPhotonScene : kEventScene);
    check_done(run_short(scene, {"-o", "whole.h5"}, folder));
    Words more;
    for (const int signal : {SIGKILL, SIGTERM, SIGKILL, SIGHUP, SIGINT, SIGKILL}) {
      CAPTURE(signal);
      const Ended stopped = stop_run(scene, more, folder, signal);
      CAPTURE(stopped.output);
      CHECK(stopped.exit_code == (signal == SIGKILL ? -1 : static_cast<int>(cli::kInterrupted)));
      if (signal != SIGKILL) CHECK_FALSE(results::read_results(folder / "out.h5").complete());
      more = {"--resume"};
    }
    // Partial results can be read before the end, too.
    check_done(run_program(
        {"merge", "out.h5.checkpoints", "--partial", "-o", "so_far.h5", "--no-report", "-q"}, folder));
    CHECK_FALSE(results::read_results(folder / "so_far.h5").complete());
    check_done(run_short(scene, {"-o", "out.h5", "--resume", "-t", "3"}, folder));
    check_same_results(folder / "whole.h5", folder / "out.h5");
    Words names = names_in(folder);
    std::sort(names.begin(), names.end());
    CHECK(names == Words{"out.h5", "output.txt", "scene.toml", "so_far.h5", "whole.h5"});
  }
}

TEST_CASE("report shows what a run that goes on, or was killed, has finished so far") {
  const auto folder = scene_folder("report_so_far", kPhotonScene);
  stop_run(kLong, {}, folder, SIGKILL);
  REQUIRE_FALSE(std::filesystem::exists(folder / "out.h5"));
  const Ended text = run_program({"report", "out.h5", "--text"}, folder);
  CAPTURE(text.output);
  CHECK(text.exit_code == cli::kSuccess);
  CHECK(contains(text.output, "merged without blocks"));
  check_done(run_program({"report", "out.h5.checkpoints", "--no-view"}, folder));
  CHECK(std::filesystem::exists(folder / "out.html"));
  CHECK_FALSE(std::filesystem::exists(folder / "out.h5"));
  check_refused({"report", "."}, folder, {"no checkpoints in this folder", "NAME.checkpoints"});
  check_refused({"report", "none.h5"}, folder, {"none.h5"});
  {
    const auto held = core::claim_output(folder / "begun.h5");
    REQUIRE(held.has_value());
    check_refused({"report", "begun.h5"}, folder, {"there is no checkpoint yet"});
  }
  check_done(run_short(kLong, {"-o", "out.h5", "--resume"}, folder));  // nothing of it was changed
}

namespace {

/// A command that keeps what it has finished in OUTPUT.journal is killed once it has begun to, and resumed to
/// the bits of one that was not; what it has finished is not gone on with, or lost, by mistake.
void check_killed_and_resumed(const Words& command, const std::filesystem::path& folder,
                              const Words& one_thread = {"-t", "1"}) {
  check_done(run_program(command + Words{"-o", "whole.h5"}, folder));
  CHECK_FALSE(std::filesystem::exists(folder / "whole.h5.journal"));
  {
    const Program program(command + one_thread + Words{"-o", "out.h5"}, folder);
    // Two sizes that are seen: one piece at least is whole.
    std::set<std::uintmax_t> sizes;
    for (int turn = 0; turn < 60'000 && sizes.size() < 2 && !std::filesystem::exists(folder / "out.h5");
         ++turn) {
      std::error_code none_yet;
      const std::uintmax_t size = std::filesystem::file_size(folder / "out.h5.journal", none_yet);
      if (!none_yet && size > 0) sizes.insert(size);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    program.signal(SIGKILL);
    CHECK(program.wait().exit_code == -1);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "out.h5"));
  check_refused(command + Words{"-o", "out.h5"}, folder, {"out.h5.journal", "--resume", "--restart"});
  check_refused(command + Words{"-o", "out.h5", "--resume", "--seed", "5"}, folder,
                {"out.h5.journal", "other work"});
  check_done(run_program(command + Words{"-o", "out.h5", "--resume"}, folder));
  check_same_results(folder / "whole.h5", folder / "out.h5", 10);  // a map has ten
  CHECK_FALSE(std::filesystem::exists(folder / "out.h5.journal"));
}

}  // namespace

TEST_CASE("A response map whose building is killed is resumed to the same bits, and only on request") {
  const auto folder = scene_folder("killed_map", kEventScene);
  const Words build{"response", "build", "scene.toml", "-q", "--pitch", "1.5 mm"};
  check_killed_and_resumed(build + Words{"--photons", "30000", "--direction", "forward"}, folder);
}

TEST_CASE("A fit that is killed is resumed to the same bits, and only on request") {
  const DarkCrystal crystal("killed_fit");
  check_killed_and_resumed({"fit", "scene.toml", "-q", "--photons", "8000"}, crystal.folder);
}

TEST_CASE("A surface table whose building is killed is resumed to the same bits, and only on request") {
  const auto folder = scratch_folder("killed_table");
  std::ofstream(folder / "map.txt") << "0 1 0 2\n1 0 3 0\n0 2 0 1\n2 0 1 0\n";
  check_killed_and_resumed(
      {"table", "build", "map.txt", "--pitch", "1 um", "--unit", "um", "--inside-index", "1.8",
       "--outside-index", "1", "--rays", "1000", "--incidence-step", "15 deg", "--no-refine"},
      folder, {});
}

TEST_CASE("A full disk loses nothing that was finished") {
  const auto folder = scene_folder("full_disk", kPhotonScene);
  check_done(run_short(kLong, {"-o", "whole.h5"}, folder));
  // The shard outgrows the limit; checkpoints of a block do not. (An HDF5 file reserves its space at the
  // start.)
  const Words shard{"run", "scene.toml", "-q", "--shard", "1/1", "-o", "all.shard"};
  const Ended full = run_program(shard + kLong.options + kOften, folder, 1'000'000);
  CAPTURE(full.output);
  CHECK(full.exit_code == cli::kSystemFailure);
  CHECK(contains(full.output, "--resume"));
  CHECK_FALSE(std::filesystem::exists(folder / "all.shard"));
  CHECK(std::filesystem::exists(folder / "all.shard.checkpoints/000001.ranges"));
  check_done(run_program(shard + kLong.options + Words{"--resume"}, folder));
  check_done(run_program({"merge", "all.shard", "-o", "out.h5", "--no-report", "-q"}, folder));
  check_same_results(folder / "whole.h5", folder / "out.h5");
}

TEST_CASE("A shard that is killed is resumed") {
  const auto folder = scene_folder("killed_shard", kPhotonScene);
  check_done(run_short(kLong, {"-o", "whole.h5"}, folder));
  CHECK(stop_run(kLong, {"--shard", "2/3"}, folder, SIGKILL).exit_code == -1);
  check_done(run_short(kLong, {"--shard", "2/3", "-o", "out.h5", "--resume"}, folder));
  std::filesystem::rename(folder / "out.h5", folder / "2.shard");
  for (const std::string shard : {"1", "3"})
    check_done(run_short(kLong, {"--shard", shard + "/3", "-o", shard + ".shard"}, folder));
  check_done(run_program({"merge", "2.shard", "3.shard", "1.shard", "-o", "merged.h5", "--no-report", "-q"},
                         folder));
  check_same_results(folder / "whole.h5", folder / "merged.h5");
}

TEST_CASE("Checkpoints of another run are never gone on with, and of this run never lost by mistake") {
  const auto folder = scene_folder("refused_resume", kPhotonScene);
  const Words run = Words{"run", "scene.toml", "--no-report", "-q", "-o", "out.h5"} + kLong.options;
  check_done(run_program(run + Words{"--resume"}, folder));  // without any it begins at the beginning
  stop_run(kLong, {}, folder, SIGKILL);
  check_refused(run, folder, {"out.h5.checkpoints", "--resume", "--restart"});
  check_refused(run + Words{"--resume", "--seed", "9"}, folder, {"seed is 9, not 1", "--restart"});
  check_refused(run + Words{"--resume", "--shard", "1/2"}, folder, {"1/2", "1/1"});
  std::filesystem::remove(folder / "out.h5.checkpoints/000001.ranges");
  check_refused(run + Words{"--resume"}, folder, {"000002.ranges", "missing"});
  std::filesystem::resize_file(folder / "out.h5.checkpoints/000002.ranges", 3000);
  check_refused(run + Words{"--resume"}, folder, {"000002.ranges", "damaged"});
  CHECK(run_program(run + Words{"--resume", "--restart"}, folder).exit_code == cli::kBadUsage);
  check_done(run_short(kLong, {"-o", "whole.h5"}, folder));
  check_done(run_program(run + Words{"--restart"}, folder));
  check_same_results(folder / "whole.h5", folder / "out.h5");

  stop_run(kLong, {}, folder, SIGKILL);
  replace_in(folder / "scene.toml", "0.93", "0.94");
  check_refused(run + Words{"--resume"}, folder, {"another text"});
  check_done(run_program(run, folder));  // of a scene that is no more, nothing is kept
  CHECK_FALSE(std::filesystem::exists(folder / "out.h5.checkpoints"));
}

TEST_CASE("merge names what is missing, and refuses what does not belong together") {
  const auto folder = scene_folder("refused_merge", kPhotonScene);
  const auto shard = [&](const std::string& number, const std::string& file, const Words& more = {}) {
    check_done(run_program(Words{"run", "scene.toml", "-q", "--shard", number, "-o", file} + more, folder));
  };
  shard("1/4", "1.shard");
  shard("3/4", "3.shard");
  const Words merge{"merge", "-o", "out.h5", "-q", "--no-report", "3.shard", "1.shard"};
  check_refused(merge, folder, {"shards 2, 4 of 4", "--partial"});
  check_done(run_program(merge + Words{"--partial"}, folder));
  const tally::RunResult partial = results::read_results(folder / "out.h5");
  CHECK_FALSE(partial.complete());
  CHECK(contains(partial.partial_reason, "shards 2, 4 of 4"));
  // Of 30 blocks those from 0 to 6 and from 15 to 21.
  CHECK(partial.points.at(0).photons == 14 * 1024);
  CHECK(results::read_photons(folder / "out.h5", 0, 100'000).size() ==
        partial.points.at(0).count(core::Fate::detected));

  shard("2/4", "other_seed.shard", {"--seed", "8"});
  check_refused(merge + Words{"other_seed.shard"}, folder, {"other_seed.shard", "seed is 8, not 1"});
  shard("2/4", "other_number.shard", {"--photons", "40000"});
  check_refused(merge + Words{"other_number.shard"}, folder, {"40000 photons", "30500 photons"});
  check_refused(merge + Words{"3.shard"}, folder, {"3.shard", "are also in"});
  shard("2/2", "half.shard");
  check_refused(merge + Words{"half.shard"}, folder, {"half.shard", "are also in"});
  check_refused(merge + Words{"scene.toml", "none.shard"}, folder,
                {"scene.toml", "not a shard", "none.shard"});
  replace_in(folder / "scene.toml", "specular_share = 0.1", "specular_share = 0.2");
  shard("2/4", "other_scene.shard");
  check_refused(merge + Words{"other_scene.shard"}, folder, {"other_scene.shard", "another text"});

  const auto damaged = folder / "damaged.shard";
  const auto size = std::filesystem::file_size(folder / "3.shard");
  for (std::uintmax_t at = 10; at < size; at += size / 17) {
    std::filesystem::copy_file(folder / "3.shard", damaged,
                               std::filesystem::copy_options::overwrite_existing);
    std::fstream file(damaged, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte ^ 16));
    file.close();
    check_refused({"merge", "damaged.shard", "-o", "out.h5", "--partial"}, folder, {"damaged.shard"});
    std::filesystem::resize_file(damaged, at);
    check_refused({"merge", "damaged.shard", "-o", "out.h5", "--partial"}, folder, {"damaged.shard"});
  }
  for (const std::string wrong : {"0/3", "4/3", "2", "2/", "a/b", "1/2x", "-1/2"}) {
    CAPTURE(wrong);
    CHECK(run_program({"run", "scene.toml", "--shard", wrong}, folder).exit_code == cli::kBadUsage);
  }
}

TEST_CASE("Shards of scenes whose files differ are not merged, and more shards than blocks are") {
  const auto folder = scene_folder("inputs", kPhotonScene);
  replace_in(folder / "scene.toml", "box = [\"2 mm\", \"2 mm\", \"6 mm\"]",
             "mesh = \"crystal.stl\"\nunit = \"mm\"");
  const auto mesh = folder / "crystal.stl";
  std::filesystem::copy_file(source_file("geometry/crystal_2x2x20.stl"), mesh);
  const Words run{"run", "scene.toml", "-q", "--photons", "2000"};
  check_done(run_program(run + Words{"--no-report", "-o", "whole.h5"}, folder));
  Words parts;
  for (int number = 1; number <= 5; ++number) {  // of two blocks
    parts.push_back(std::to_string(number) + ".shard");
    check_done(
        run_program(run + Words{"--shard", std::to_string(number) + "/5", "-o", parts.back()}, folder));
  }
  check_done(run_program(Words{"merge", "-q", "--no-report", "-o", "merged.h5"} + parts, folder));
  check_same_results(folder / "whole.h5", folder / "merged.h5");
  // The same triangles in other bytes: the text at the beginning of an STL file.
  std::fstream(mesh, std::ios::in | std::ios::out | std::ios::binary) << "another";
  check_done(run_program(run + Words{"--shard", "3/5", "-o", "3.shard"}, folder));
  check_refused(Words{"merge", "-o", "merged.h5"} + parts, folder, {"3.shard", "crystal.stl"});
}

TEST_CASE("Of two processes on one output the second is refused, and what a killed one left is removed") {
  const auto folder = scene_folder("two_processes", kPhotonScene);
  const Words run{"run", "scene.toml", "-q", "--no-report", "-o", "out.h5", "--photons", "2000000000"};
  const auto writes = [&] {
    for (const std::string& name : names_in(folder))
      if (name.starts_with(".out.h5.") && name.ends_with(".unfinished")) return true;
    return false;
  };
  const Program first(run, folder);
  for (int turn = 0; turn < 60'000 && !writes(); ++turn)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  check_refused(run, folder, {"out.h5", "another process"});
  check_refused({"merge", "scene.toml", "-o", "out.h5"}, folder, {"another process"});
  first.signal(SIGKILL);
  first.wait();
  CHECK(writes());
  check_done(run_program({"run", "scene.toml", "-q", "--no-report", "-o", "out.h5", "--restart"}, folder));
  CHECK_FALSE(writes());
}
