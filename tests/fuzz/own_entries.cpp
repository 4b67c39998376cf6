#include "own_entries.hpp"

#include <cstring>
#include <functional>
#include <iterator>
#include <string_view>

#include "corpus.hpp"
#include "require.hpp"
#include "scintray/config/columns.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/journal.hpp"
#include "scintray/core/zlib_stream.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/range_file.hpp"
#include "scintray/simulation/response.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"
#include "scintray/tables/import_settings.hpp"
#include "scratch_file.hpp"

namespace scintray::fuzz {

namespace {

const char* const kScene = R"(
title = "A crystal"
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
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
)";
const char* const kPhotons = R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
time = "decay"
photons = 60
photons_per_event = 20
[run]
photon_list = true
photon_history = true
paths = 3
[[tally]]
type = "count"
name = "path"
at = "detected"
score = "path"
axes = [{ variable = "time", from = "0 ns", to = "200 ns", bins = 20 }]
)";
const char* const kEvents = R"(
[source]
type = "gamma_events"
events = 3
region = { part = "crystal" }
energy = "5 keV"
[readout]
period = "0.5 ns"
before = "5 ns"
window = "20 ns"
shaping = { order = 1, time_constant = "5 ns" }
threshold = 1
pulses = true
photon_order = [1, 3]
)";

const std::string kSweep = std::string(kPhotons) + "[[sweep]]\nkey = \"source.photons\"\nvalues = [60, 70]\n";

std::vector<std::string> scene_seeds() {
  std::vector<std::string> seeds = scene_files();
  for (const std::string& more : {std::string(kPhotons), std::string(kEvents), kSweep})
    seeds.push_back(kScene + more);
  return seeds;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What `write` puts at a path, without the seal of HDF5 files.
template <typename Write>
std::string written(const char* ending, const Write& write) {
  const ScratchFile file(nullptr, 0, ending);
  std::filesystem::remove(file.path());  // results are not written over what is none
  write(file.path());
  const std::string bytes = content_of(file.path());
  return bytes.substr(0, bytes.rfind("\nScintRay seal"));
}

/// Files of the two scenes, written by a sink.
template <typename Sink>
std::vector<std::string> files_of(const char* ending) {
  std::vector<std::string> files;
  for (const char* source : {kPhotons, kEvents})
    files.push_back(written(ending, [&](const std::filesystem::path& path) {
      Sink sink(path);
      simulation::Simulation(scene_file::SceneFile::from_text(std::string(kScene) + source, "scene.toml"))
          .run_all(sink);
    }));
  return files;
}

std::vector<std::string> range_seeds() { return files_of<simulation::RangeFile>(".shard"); }
std::vector<std::string> results_seeds() { return files_of<simulation::ResultsFile>(".h5"); }

std::vector<std::string> response_seeds() {
  simulation::ResponseFile file;
  file.version = "1.2.3";
  file.scene_file = "scene.toml";
  file.scene_text = kScene;
  file.map.channels = {"pmt", "other"};
  file.map.photons_per_cell = 50;
  file.map.delays_kept = 3;
  simulation::ResponseGrid grid;
  grid.part = "crystal";
  grid.low = core::Vec3(-1, -1, 0);
  grid.pitch = core::Vec3(2, 1, 4);
  grid.cells = {1, 2, 1};
  grid.photons = {50, 0};
  grid.detected = {20, 2, 0, 0};
  grid.delays_ns = {0.1f, 0.2f, 0.3f, 1.5f, 2.5f};
  file.map.grids = {grid};
  return {written(".h5", [&](const std::filesystem::path& path) { write_response(path, file); })};
}

/// A shard of the whole of a map, traced forward and backward.
std::vector<std::string> map_shard_seeds() {
  std::vector<std::string> files;
  for (const auto direction : {simulation::MapDirection::forward, simulation::MapDirection::backward})
    files.push_back(written(".shard", [&](const std::filesystem::path& path) {
      simulation::MapOptions options;
      options.settings = {2.0, 5, 2, direction, 40};
      options.shard = {path, {1, 1}};
      const std::string text = std::string(kScene) + kEvents;
      simulation::build_map(scene_file::SceneFile::from_text(text, "scene.toml"), options);
    }));
  return files;
}

/// Reads, and checks that what is refused is so with words.
template <typename Read>
bool read_or_input_error(const Read& read) {
  try {
    read();
    return true;
  } catch (const core::InputError& error) {
    require(!error.problems().empty() && !error.problems().front().what.empty(), "an error without words");
    return false;
  } catch (const core::SystemError&) {  // as HDF5 cannot read what is there
    return false;
  }
}

bool run_scene(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  return read_or_input_error(
      [&] { scene_file::SceneFile::from_text(text, (scene_folder() / "fuzz.toml").string()); });
}

/// The bytes with the checksums of their records made to fit, so that damage is not found by them alone.
std::string resealed(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHead = 1 + sizeof(std::uint64_t), kTail = sizeof(std::uint32_t);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  std::size_t at = bytes.find('\n') + 1 + sizeof(std::uint32_t);
  while (at > 0 && at < size && size - at >= kHead + kTail) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, sizeof length);
    if (length > size - at - kHead - kTail) break;
    const std::uint32_t sum = core::crc32(std::string_view(bytes).substr(at, kHead + length));
    std::memcpy(bytes.data() + at + kHead + length, &sum, kTail);
    at += kHead + length + kTail;
  }
  return bytes;
}

/// Runs a reader on the bytes with fitting checksums.
template <bool (*Run)(const std::uint8_t*, std::size_t)>
bool run_resealed(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = resealed(data, size);
  return Run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

bool run_ranges(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".shard");
  return read_or_input_error([&] {
    simulation::MemorySink memory;
    simulation::merge_ranges({file.path()}, memory, true);
  });
}

bool run_map_shard(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".shard");
  return read_or_input_error([&] { simulation::merge_map_shards({file.path()}); });
}

bool run_results(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".h5");
  std::size_t points = 0;
  const bool read = read_or_input_error([&] { points = results::read_results(file.path()).points.size(); });
  // One of the others, as each examines the whole file again.
  switch (std::hash<std::string_view>()({reinterpret_cast<const char*>(data), size}) % 6) {
    case 0:
      read_or_input_error([&] { results::read_photon_layout(file.path()); });
      break;
    case 1:
      read_or_input_error([&] { results::read_photons(file.path(), 0, 1000); });
      break;
    case 2:
      read_or_input_error([&] { results::read_surfaces(file.path()); });
      break;
    case 3:
      for (std::size_t point = 0; point < points; ++point)
        read_or_input_error([&] { results::read_channels(file.path(), point); });
      break;
    case 4:
      read_or_input_error([&] { results::read_photon_order(file.path()); });
      break;
    default:
      read_or_input_error([&] { results::read_events(file.path(), 0, 1000); });
  }
  return read;
}

std::vector<std::string> journal_seeds() {
  return {written(".journal", [](const std::filesystem::path& path) {
    core::Journal journal({path, core::JournalStart::resume}, "work");
    for (const char* key : {"one", "two", "three"}) journal.add(key, std::string(40, key[0]));
  })};
}

bool run_journal(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".journal");
  return read_or_input_error([&] {
    const core::Journal journal({file.path(), core::JournalStart::resume}, "work");
    for (const char* key : {"one", "two", "three"}) {
      const auto piece = journal.find(key);
      require(!piece || *piece == std::string(40, key[0]), "a piece that was never written");
    }
  });
}

std::vector<std::string> table_seeds() {
  const auto node = [](double degrees, double reflectance) {
    optics::TableNode made;
    made.incidence_rad = made.traced_incidence_rad = degrees * core::kDegree;
    made.reflectance = reflectance;
    made.reflected = tables::single_direction(degrees * core::kDegree, 0.0);
    made.transmitted = tables::single_direction(0.5, 0.25);
    return made;
  };
  const optics::SurfaceTable table({1.82, 1.0}, {node(0, 0.1), node(90, 1.0)}, {node(0, 0.1), node(90, 0.9)},
                                   {});
  return {written(".h5", [&](const std::filesystem::path& path) { optics::write_table(path, table); })};
}

bool run_table(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".h5");
  return read_or_input_error([&] { optics::read_table(file.path()); });
}

std::vector<std::string> column_seeds() {
  return {written(".h5", [](const std::filesystem::path& path) {
    core::h5::File file = core::h5::File::create(path);
    core::h5::Group hits = file.root().create_group("hits");
    for (const char* name : {"event", "x", "energy"}) hits.write(name, std::vector<double>(300, 1.5));
    file.commit();
  })};
}

bool run_columns(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".h5");
  return read_or_input_error([&] {
    config::read_columns({file.path(), "hits", {}}, {"event", "x", "", "energy"});
  });
}

bool run_response(const std::uint8_t* data, std::size_t size) {
  const ScratchFile file(data, size, ".h5");
  return read_or_input_error([&] { simulation::read_response(file.path()); });
}

/// Sums of tallies are stored sparsely: a few bytes are a tally of as many bins as may be.
constexpr std::size_t kPerOwnByte = 4096, kOwnAlways = std::size_t{1} << 30;

constexpr Entry kOwnEntries[] = {
    {"scene", run_scene, scene_seeds, kPerOwnByte, kOwnAlways},
    {"ranges", run_ranges, range_seeds, kPerOwnByte, kOwnAlways},
    {"map_shard", run_map_shard, map_shard_seeds, kPerOwnByte, kOwnAlways},
    {"map_shard_sealed", run_resealed<run_map_shard>, map_shard_seeds, kPerOwnByte, kOwnAlways},
    {"ranges_sealed", run_resealed<run_ranges>, range_seeds, kPerOwnByte, kOwnAlways},
    {"results", run_results, results_seeds, kPerOwnByte, kOwnAlways},
    {"response", run_response, response_seeds, kPerOwnByte, kOwnAlways},
    {"table", run_table, table_seeds, kPerOwnByte, kOwnAlways},
    {"columns_hdf5", run_columns, column_seeds, kPerOwnByte, kOwnAlways},
    {"journal", run_journal, journal_seeds, kPerOwnByte, kOwnAlways}};

}  // namespace

std::span<const Entry> own_entries() { return kOwnEntries; }

}  // namespace scintray::fuzz
