#include "scintray/simulation/response.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "scintray/core/h5.hpp"
#include "scintray/results/results.hpp"
#include "scintray/simulation/results_file.hpp"
#include "support/shared.hpp"
#include "support/small_crystal.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::results;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

SceneFile read_text(const std::string& text) { return SceneFile::from_text(text, "scene.toml"); }

std::string with(std::string text, const std::string& old, const std::string& now) {
  const auto at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), now);
}

ResponseFile made_up_map() {
  ResponseFile file;
  file.version = "1.2.3";
  file.scene_file = "scene.toml";
  file.scene_text = kSmallCrystal;
  file.map.channels = {"pmt", "other"};
  file.map.seed = ~0ull;
  file.map.photons_per_cell = 50;
  file.map.delays_kept = 3;
  file.map.unpolarised = true;
  ResponseGrid grid;
  grid.part = "crystal";
  grid.low = Vec3(-1, -1, 0);
  grid.pitch = Vec3(2, 1, 4);
  grid.cells = {1, 2, 1};
  grid.photons = {50, 0};
  grid.detected = {20, 2, 0, 0};
  grid.delays_ns = {0.1f, 0.2f, 0.3f, 1.5f, 2.5f};
  file.map.grids = {grid};
  return file;
}

std::string refusal(const std::filesystem::path& path, const ResponseFile& file) {
  write_response(path, file);
  return complaint_of([&] { read_response(path); });
}

}  // namespace

TEST_CASE("A response map comes back from its file as it was") {
  const auto path = scratch_folder("response_round_trip") / "map.h5";
  const ResponseFile wrote = made_up_map();
  write_response(path, wrote);
  const ResponseFile read = read_response(path);
  CHECK(read.version == wrote.version);
  CHECK(read.scene_file == wrote.scene_file);
  CHECK(read.scene_text == wrote.scene_text);
  CHECK(read.map.channels == wrote.map.channels);
  CHECK(read.map.seed == wrote.map.seed);
  CHECK(read.map.photons_per_cell == 50);
  CHECK(read.map.delays_kept == 3);
  CHECK(read.map.unpolarised);
  REQUIRE(read.map.grids.size() == 1);
  const ResponseGrid &a = wrote.map.grids[0], &b = read.map.grids[0];
  CHECK(b.part == "crystal");
  CHECK((a.low == b.low && a.pitch == b.pitch && a.cells == b.cells));
  CHECK((a.photons == b.photons && a.detected == b.detected && a.delays_ns == b.delays_ns));
  const auto probability =
      h5::File::open(path).root().open_group("grids").open_group("0000").read<float>("probability");
  REQUIRE(probability.size() == 4);
  CHECK(probability[0] == doctest::Approx(0.4));
  CHECK(std::isnan(probability[2]));
}

TEST_CASE("A response map traced backward comes back with its probabilities, and bad ones are refused") {
  const auto path = scratch_folder("response_backward") / "map.h5";
  ResponseFile file = made_up_map();
  file.map.photons_per_cell = 0;
  file.map.photons_per_channel = 25;
  ResponseGrid& grid = file.map.grids[0];
  grid.probabilities = {0.25f, 0.125f, 0.0f, 0.0f};
  grid.probability_errors = {0.01f, 0.02f, 0.0f, 0.0f};
  write_response(path, file);
  const ResponseFile read = read_response(path);
  CHECK(read.map.backward());
  CHECK(read.map.photons_per_channel == 25);
  CHECK(read.map.photons_per_cell == 0);
  CHECK(read.map.grids[0].probabilities == grid.probabilities);
  CHECK(read.map.grids[0].probability_errors == grid.probability_errors);
  grid.probabilities[1] = 0.0f;
  check_contains(refusal(path, file), {"probability", "photons_detected"});
  grid.probabilities[1] = -1.0f;
  check_contains(refusal(path, file), {"probability", "no probability"});
}

TEST_CASE("Response maps that contradict themselves, and files that are none, are refused with the reason") {
  const auto folder = scratch_folder("response_refused");
  const auto path = folder / "map.h5";
  ResponseFile file = made_up_map();
  file.map.grids[0].delays_ns.pop_back();
  check_contains(refusal(path, file), {"delay_ns", "the length", "counts"});
  file = made_up_map();
  file.map.grids[0].detected[0] = 49;
  check_contains(refusal(path, file), {"more photons", "detected", "emitted"});
  file = made_up_map();
  file.map.grids[0].pitch.z() = 0.0;
  check_contains(refusal(path, file), {"corner or the pitch of the grid", "\"crystal\""});
  file = made_up_map();
  file.map.grids[0].delays_ns[1] = -1.0f;
  check_contains(refusal(path, file), {"delay_ns", "not a time"});
  file = made_up_map();
  file.map.grids[0].photons = {0, 0};
  file.map.grids[0].detected = {0, 0, 0, 0};
  file.map.grids[0].delays_ns.clear();
  check_contains(refusal(path, file), {"all cells", "\"crystal\"", "empty"});
  file = made_up_map();
  file.map.photons_per_cell = 0;
  check_contains(refusal(path, file), "0 as its photons_per_cell");

  std::ofstream(folder / "thesis.tex") << "years of work";
  check_contains(complaint_of([&] { write_response(folder / "thesis.tex", made_up_map()); }),
                 "not written over");
  {
    auto other = h5::File::create(folder / "other.h5");
    other.commit();
  }
  check_contains(complaint_of([&] { read_response(folder / "other.h5"); }), "not a response map");
  {
    auto newer = h5::File::create(folder / "newer.h5");
    newer.root().set_attribute("", "format", std::string("scintray-response"));
    newer.root().set_attribute("", "version", kResponseVersion + 1);
    newer.root().set_attribute("", "scintray_version", std::string("9.8.7"));
    newer.commit();
  }
  check_contains(complaint_of([&] { read_response(folder / "newer.h5"); }),
                 "format version 3 (written by ScintRay 9.8.7)");
}

TEST_CASE("A response map fits scenes that differ only in what does not affect light transport") {
  ResponseFile map = made_up_map();
  map.map.unpolarised = false;
  const auto complaint = [&](const std::string& text) {
    return complaint_of([&] { require_same_scene(read_text(text), map); });
  };
  CHECK(complaint(kSmallCrystal).empty());
  CHECK(complaint(with(kSmallCrystal, "\"A small crystal\"", "\"else\"")).empty());
  CHECK(complaint(with(kSmallCrystal, "\"100 keV\"", "\"511 keV\"") + "[run]\nseed = 7\n").empty());
  check_contains(complaint(with(kSmallCrystal, "\"polished\"", "\"lso_ground_30um\"")),
                 "\"part.crystal.surface\" differs");
  check_contains(complaint(with(kSmallCrystal, "\"4 mm\"", "\"5 mm\"")), "\"part.crystal.box.3\" differs");
  check_contains(
      complaint(kSmallCrystal + "[media.extra]\nindex = { n = 1.5 }\nabsorption = { none = true }\n"
                                "scattering = { none = true }\n"),
      "\"media\" differs");
  check_contains(complaint(with(kSmallCrystal, "[source]", "[source]\npolarisation = \"unpolarised\"")),
                 "in contradiction to source.polarisation");
}

TEST_CASE("Events from a response map are a result whose note names it") {
  const auto folder = scratch_folder("response_run");
  const SceneFile scene = read_text(kSmallCrystal);
  MapOptions options;
  options.settings = {2.0, 200, 8};
  const ResponseFile map = build_map(scene, options);
  write_response(folder / "map.h5", map);
  SimulationOptions simulation;
  simulation.events = 40;
  ResultsFile results(folder / "result.h5");
  const RunResult made = simulate_mapped(scene, folder / "map.h5", results, simulation);
  CHECK(made.complete());
  const RunResult read = read_results(folder / "result.h5");
  CHECK(read.points.at(0).energy.events == 40);
  check_contains(read.header.note, "events from the response map map.h5");
  const std::vector<EventRecord> events = read_events(folder / "result.h5", 0, 100);
  REQUIRE(events.size() == 40);
  for (const EventRecord& event : events) {
    CHECK(event.energy_keV == 100.0f);
    CHECK(event.detected > 0);
    CHECK(event.channels.at(0).detected == event.detected);
    CHECK(event.channels[0].first_ns > 0.0f);
  }
  CHECK(read_channels(folder / "result.h5", 0).at(0).name == "pmt");

  ResponseFile moved = map;
  moved.map.grids[0].low.z() += 0.5;
  write_response(folder / "moved.h5", moved);
  check_contains(complaint_of([&] { simulate_mapped(scene, folder / "moved.h5", results, simulation); }),
                 {"\"crystal\"", "another place or size"});
}

TEST_CASE("Scenes without a possible response map are refused with the reason") {
  const auto complaint = [](const std::string& text) {
    return complaint_of([&] { build_map(read_text(text), {}); });
  };
  check_contains(complaint(kSmallCrystal + "[[sweep]]\nkey = \"source.events\"\nvalues = [1, 2]\n"),
                 "has a sweep");
  std::string photons = kSmallCrystal.substr(0, kSmallCrystal.find("[source]"));
  photons +=
      "[source]\ntype = \"photons\"\nregion = { part = \"crystal\" }\nwavelength = \"420 nm\"\nphotons = 1\n";
  check_contains(complaint(photons), "source of photons");
}
