// Files of block ranges: what they hold, what they refuse, and what damaged ones may do.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "scenes.hpp"
#include "scintray/core/zlib_stream.hpp"
#include "scintray/simulation/detail/range_records.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

const std::string kRowsOfLight = "[run]\nphoton_list = true\nphoton_history = true\npaths = 20\n";
const std::string kPathTally = R"(
[[tally]]
type = "count"
name = "path"
at = "detected"
score = "path"
axes = [{ variable = "time", from = "0 ns", to = "200 ns", bins = 20 }]
)";
const std::string kElectronics = R"(
[readout]
period = "0.5 ns"
before = "5 ns"
window = "50 ns"
shaping = { order = 1, time_constant = "5 ns" }
threshold = 3
pulses = true
photon_order = [1, 3]
)";

/// The file of one shard of a scene.
std::filesystem::path shard_file(const std::string& scene, const Shard& shard, const std::string& name) {
  const auto path = scratch_folder("ranges_" + name) / "a.shard";
  RangeFile file(path, shard);
  Simulation(scene_of(scene)).run_all(file, {}, shard);
  return path;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Positions of the content of each record, after a head of nine bytes with its length, in a sound file.
std::vector<std::pair<std::size_t, std::size_t>> records_of(const std::string& bytes) {
  std::vector<std::pair<std::size_t, std::size_t>> records;
  for (std::size_t at = 22 + 4; at < bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, sizeof(length));
    records.emplace_back(at + 9, length);
    at += 9 + length + 4;
  }
  return records;
}

/// True when the bytes, written to a file, are read and merged; false when they are refused by an InputError.
bool merges(const std::string& bytes, const std::filesystem::path& folder) {
  const auto path = folder / "changed.shard";
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    MemorySink memory;
    merge_ranges({path}, memory, true);
    return true;
  } catch (const InputError& error) {
    CHECK_FALSE(error.problems().front().what.empty());
    return false;
  }
}

}  // namespace

TEST_CASE("Shards of a sweep divide its blocks, and merge in memory to what one run returns") {
  const std::string scene =
      kCrystal + kPhotons + kRowsOfLight + kPathTally + kSurfaceSweep;  // three points of three blocks
  MemorySink whole, merged;
  Simulation(scene_of(scene)).run_all(whole);
  std::vector<std::filesystem::path> files;
  for (std::uint64_t number = 4; number >= 1; --number)
    files.push_back(shard_file(scene, {number, 4}, "sweep_" + std::to_string(number)));
  merge_ranges(files, merged);
  REQUIRE(merged.result.points.size() == 3);
  CHECK(merged.result.complete());
  CHECK(merged.photon_list.size() == whole.photon_list.size());
  for (std::size_t i = 0; i < 3; ++i) {
    const tally::PointResult &a = whole.result.points[i], &b = merged.result.points[i];
    CHECK(a.parameters == b.parameters);
    CHECK(a.fates == b.fates);
    CHECK(a.photons_requested == b.photons_requested);
    CHECK(a.detected_time_ns.sum == b.detected_time_ns.sum);
    CHECK(a.detected_time_ns.sum_of_squares == b.detected_time_ns.sum_of_squares);
    CHECK(a.tallies.at(0).sum == b.tallies.at(0).sum);
    CHECK(a.tallies.at(0).sum_of_squares == b.tallies.at(0).sum_of_squares);
    CHECK(a.tallies.at(0).sum != std::vector<double>(20, 0.0));
    CHECK(whole.history_list.at(i).rows.path_mm == merged.history_list.at(i).rows.path_mm);
    REQUIRE(whole.path_list.at(i).size() == 20);
    REQUIRE(merged.path_list.at(i).size() == 20);
    for (std::size_t k = 0; k < 20; ++k) {
      const tally::PhotonPath &of = whole.path_list[i][k], &there = merged.path_list[i][k];
      CHECK(of.photon == there.photon);
      CHECK(of.fate == there.fate);
      REQUIRE(of.steps.size() == there.steps.size());
      CHECK(of.steps.back().position == there.steps.back().position);
      CHECK(of.steps.back().time_ns == there.steps.back().time_ns);
      CHECK(of.steps.back().text == there.steps.back().text);
    }
  }
  // Of 9 blocks in all: 0 to 1, 2 to 3, 4 to 5 (in the second point), 6 to 8.
  const RangeReader third(files[1]);
  REQUIRE(third.ranges().size() == 1);
  CHECK(third.ranges()[0].point == 1);
  CHECK(third.ranges()[0].blocks == tally::BlockRange{1, 3});
}

TEST_CASE("A detected photon takes the bytes of the columns that its list has, and no others") {
  const auto bytes_a_photon = [](const std::string& columns) {
    const std::string scene = kCrystal + kPhotons + "[run]\nphoton_list = true\n" + columns;
    const auto path = shard_file(scene, {}, "columns");
    const std::string bytes = bytes_of(path);
    std::size_t total = 0;
    for (const auto& [from, length] : records_of(bytes))
      if (static_cast<detail::Record>(bytes[from - 9]) == detail::Record::photons) total += length;
    MemorySink photons;
    merge_ranges({path}, photons);
    REQUIRE(photons.photon_list.size() > 100);
    return static_cast<double>(total) / static_cast<double>(photons.photon_list.size());
  };
  CHECK(bytes_a_photon("") == 64);
  CHECK(bytes_a_photon("photon_columns = [\"time_ns\"]\n") == 4);
  CHECK(bytes_a_photon("photon_columns = [\"event\", \"photon\", \"part\"]\n") == 20);
}

TEST_CASE("What differs between two runs is named: version, text, seed, work, files, limits") {
  Simulation simulation(scene_of(kCrystal + kPhotons));
  const RunOutline run = simulation.outline();
  CHECK(difference(run, run).empty());
  CHECK(run.inputs.size() >= 4);  // definitions of two media, a surface, a sensor at least
  const auto differs = [&](const auto& change, const std::string& words) {
    RunOutline other = run;
    change(other);
    CAPTURE(words);
    CHECK(contains(difference(other, run), words));
    CHECK_FALSE(difference(run, other).empty());
  };
  differs([](RunOutline& o) { o.header.version = "9.9"; }, "9.9");
  differs([](RunOutline& o) { o.header.scene_text += "#"; }, "text");
  differs([](RunOutline& o) { o.header.seed = 77; }, "77");
  differs([](RunOutline& o) { o.points[0].work = 123; }, "123 photons");
  differs([](RunOutline& o) { o.inputs[0].sha256[0] = 'x'; }, run.inputs[0].name);
  differs([](RunOutline& o) { o.inputs.push_back({"more.toml", "0"}); }, "input files");
  differs([](RunOutline& o) { o.points[0].max_time_ns = 3.0; }, "limits");
  RunOutline elsewhere = run;
  elsewhere.header.scene_file = "/another/folder/scene.toml";
  elsewhere.header.note = "a warning";
  CHECK(difference(elsewhere, run).empty());
}

TEST_CASE("A file of ranges that lies is refused, or read, and nothing else happens") {
  for (const std::string& scene :
       {kCrystal + kPhotons + kRowsOfLight + kPathTally, kCrystal + kEvents + kElectronics,
        kCrystal + kPhotons + "[run]\nphoton_list = true\nphoton_columns = [\"part\"]\n"}) {
    const auto path = shard_file(scene, {}, "lies");
    const std::string sound = bytes_of(path);
    REQUIRE(merges(sound, path.parent_path()));
    const auto records = records_of(sound);
    REQUIRE(records.size() >= 4);
    std::mt19937_64 random(5);
    std::size_t refused = 0;
    constexpr std::size_t kTurns = 1500;
    for (std::size_t turn = 0; turn < kTurns; ++turn) {
      std::string bytes = sound;
      const auto [from, length] = records[random() % (records.size() - 1)];
      constexpr unsigned char kOdd[] = {0x00, 0xff, 0x7f, 0x80, 0x01};
      // The first bytes of a record are counts and numbers; the rest is mostly rows.
      const std::size_t within = turn % 2 == 0 ? std::min<std::size_t>(length, 200) : length;
      for (std::size_t k = 0; k <= random() % 3; ++k)
        bytes[from + random() % within] = static_cast<char>(kOdd[random() % std::size(kOdd)]);
      const std::uint32_t sum = crc32(std::string_view(bytes).substr(from - 9, length + 9));
      std::memcpy(bytes.data() + from + length, &sum, sizeof(sum));
      refused += merges(bytes, path.parent_path()) ? 0 : 1;
    }
    CHECK(refused > kTurns / 20);
    for (std::size_t cut = 0; cut < sound.size(); cut += sound.size() / 50)
      CHECK_FALSE(merges(sound.substr(0, cut), path.parent_path()));
    CHECK_FALSE(merges(sound + "x", path.parent_path()));
  }
}
