#include "scintray/results/results.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

#include "analysis/made_up_events.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "support/made_up_result.hpp"
#include "support/made_up_surface.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::results;
using namespace scintray::test;

namespace {

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<DetectedPhoton> made_up_photons(std::uint64_t count) {
  std::vector<DetectedPhoton> photons(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    DetectedPhoton& photon = photons[i];
    const auto x = static_cast<float>(i);
    photon = {static_cast<std::uint32_t>(i % 15),
              i << 33,
              ~i,
              PartId(1),
              FaceId(2),
              {x, -x, 0.1f * x},
              {0.6f, 0, 0.8f},
              420.5f,
              1e-3f * x,
              3.0f + x,
              static_cast<std::uint32_t>(i % 97)};
  }
  return photons;
}

/// DetectedPhoton has padding, so compare what counts.
bool same(const DetectedPhoton& a, const DetectedPhoton& b) {
  return a.point == b.point && a.event == b.event && a.photon == b.photon && a.part == b.part &&
         a.face == b.face && a.position_mm == b.position_mm && a.direction == b.direction &&
         a.wavelength_nm == b.wavelength_nm && a.time_ns == b.time_ns && a.path_mm == b.path_mm &&
         a.interactions == b.interactions;
}

void write(const std::filesystem::path& path, const RunResult& run,
           const std::vector<DetectedPhoton>& photons) {
  ResultsWriter writer(path, run.header, !photons.empty());
  writer.add_surfaces({test::made_up_surface("ground", "air")});
  if (!photons.empty()) writer.append_photons(photons);
  for (const PointResult& point : run.points) writer.add_point(point);
  writer.commit(run.partial_reason.empty(), run.partial_reason);
}

void check_same(const Moments& a, const Moments& b) {
  CHECK(a.count == b.count);
  CHECK(a.sum == b.sum);
  CHECK(a.sum_of_squares == b.sum_of_squares);
}

void check_same(const PointResult& a, const PointResult& b) {
  CHECK(a.parameters == b.parameters);
  CHECK(a.photons_requested == b.photons_requested);
  CHECK(a.photons == b.photons);
  CHECK(a.complete == b.complete);
  CHECK(a.fates == b.fates);
  CHECK(a.absorbed_in_medium == b.absorbed_in_medium);
  CHECK(a.absorbed_at_surface == b.absorbed_at_surface);
  CHECK((a.shifted_in_medium == b.shifted_in_medium));
  CHECK((a.shifted_at_surface == b.shifted_at_surface));
  REQUIRE(a.sensor_faces.size() == b.sensor_faces.size());
  for (std::size_t i = 0; i < a.sensor_faces.size(); ++i) {
    CHECK(a.sensor_faces[i].part == b.sensor_faces[i].part);
    CHECK(a.sensor_faces[i].face == b.sensor_faces[i].face);
    CHECK(a.sensor_faces[i].detected == b.sensor_faces[i].detected);
    CHECK(a.sensor_faces[i].not_detected == b.sensor_faces[i].not_detected);
  }
  const std::vector<CrossingAngles> angles = crossing_angles(a), read = crossing_angles(b);
  REQUIRE(angles.size() == read.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    CHECK(angles[i].name == read[i].name);
    CHECK(angles[i].face == read[i].face);
    CHECK(angles[i].detected_only == read[i].detected_only);
    CHECK(angles[i].inside == read[i].inside);
    CHECK(angles[i].outside == read[i].outside);
  }
  check_same(a.interactions, b.interactions);
  check_same(a.detected_path_mm, b.detected_path_mm);
  check_same(a.detected_time_ns, b.detected_time_ns);
  check_same(a.detected_interactions, b.detected_interactions);
  CHECK(a.detected_path_histogram == b.detected_path_histogram);
  CHECK(a.scatterings == b.scatterings);
  CHECK(a.segments == b.segments);
  CHECK(a.resolved_misses == b.resolved_misses);
  CHECK(a.lost == b.lost);
  CHECK(a.wall_seconds == b.wall_seconds);
}

}  // namespace

TEST_CASE("A result comes back from its file bit for bit") {
  const auto path = test::scratch_folder("results_round_trip") / "run.h5";
  RunResult run = test::made_up_run();
  run.points[3].complete = false;
  run.points[3].lost = 7;
  const auto photons = made_up_photons(200'000);
  write(path, run, photons);
  const RunResult read = read_results(path);
  CHECK(read.header.title == run.header.title);
  CHECK(read.header.version == run.header.version);
  CHECK(read.header.scene_file == run.header.scene_file);
  CHECK(read.header.scene_text == run.header.scene_text);
  CHECK(read.header.seed == run.header.seed);
  CHECK(read.header.sweep_keys == run.header.sweep_keys);
  CHECK(read.header.media == run.header.media);
  CHECK(read.header.surfaces == run.header.surfaces);
  CHECK(read.header.parts == run.header.parts);
  CHECK(read.header.faces == run.header.faces);
  CHECK(read.header.note == run.header.note);
  REQUIRE(read.points.size() == run.points.size());
  for (std::size_t i = 0; i < run.points.size(); ++i) check_same(read.points[i], run.points[i]);
  const auto status = read_results_status(path);
  CHECK(status.complete);
  CHECK(status.listed_photons == photons.size());
  const auto listed = read_photons(path, 0, photons.size());
  REQUIRE(listed.size() == photons.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < photons.size(); ++i) different += same(listed[i], photons[i]) ? 0 : 1;
  CHECK(different == 0);
  const auto tail = read_photons(path, 199'999, 10);
  REQUIRE(tail.size() == 1);
  CHECK(same(tail[0], photons.back()));
}

TEST_CASE("An interrupted run keeps what was computed, with the reason why it is partial") {
  const auto path = test::scratch_folder("results_partial") / "run.h5";
  RunResult run = test::made_up_run();
  run.points.resize(2);
  run.partial_reason = "interrupted by Ctrl-C";
  write(path, run, {});
  const RunResult read = read_results(path);
  CHECK_FALSE(read.complete());
  CHECK(read.partial_reason == "interrupted by Ctrl-C");
  CHECK(read.points.size() == 2);
  CHECK_FALSE(read_results_status(path).complete);
  check_contains(message_of([&] { read_photons(path, 0, 1); }), {"no list", "detected photons"});
}

TEST_CASE("A result that is not committed leaves nothing behind") {
  const auto folder = test::scratch_folder("results_uncommitted");
  {
    ResultsWriter writer(folder / "run.h5", test::made_up_run().header, true);
    writer.append_photons(made_up_photons(100'000));
  }
  CHECK(std::filesystem::is_empty(folder));
}

TEST_CASE("A result replaces a result, and never anything else") {
  const auto folder = test::scratch_folder("results_overwrite");
  const RunResult run = test::made_up_run();
  write(folder / "run.h5", run, {});
  CHECK(is_results_file(folder / "run.h5"));
  CHECK_NOTHROW(write(folder / "run.h5", run, {}));
  std::ofstream(folder / "thesis.h5") << "years of work";
  {
    auto other = h5::File::create(folder / "other.h5");
    other.root().write("x", std::vector<double>{1.0});
    other.commit();
  }
  for (const auto& path : {folder / "thesis.h5", folder / "other.h5", std::filesystem::path("/dev/full")}) {
    const auto message = message_of([&] { ResultsWriter(path, run.header, false); });
    CHECK(contains(message, path.string()));
    CHECK(contains(message, "not written over"));
    CHECK(contains(message, "hint: "));
  }
  CHECK(text_of(folder / "thesis.h5") == "years of work");
  CHECK(contains(message_of([&] { ResultsWriter(folder / "no" / "run.h5", run.header, false); }),
                 "there is no folder"));
}

TEST_CASE("Files that are not results of this version are refused with a reason") {
  const auto folder = test::scratch_folder("results_refused");
  const auto path = folder / "newer.h5";
  {
    auto file = h5::File::create(path);
    file.root().set_attribute("", "format", std::string("scintray-results"));
    file.root().set_attribute("", "version", kResultsVersion + 1);
    file.root().set_attribute("", "scintray_version", std::string("9.8.7"));
    file.commit();
  }
  const auto newer = message_of([&] { read_results(path); });
  CHECK(contains(newer, "format version 3 (written by ScintRay 9.8.7)"));
  CHECK(contains(newer, "reads versions 1 to 2"));
  CHECK(contains(newer, "use a newer ScintRay"));
  {
    auto file = h5::File::create(folder / "other.h5");
    file.commit();
  }
  CHECK(contains(message_of([&] { read_results(folder / "other.h5"); }), "not a ScintRay result"));
  CHECK(contains(message_of([&] { read_results(folder / "none.h5"); }), "no such file"));
  std::ofstream(folder / "text.h5") << "hello";
  CHECK(contains(message_of([&] { read_results(folder / "text.h5"); }), "not an HDF5 file"));
  write(folder / "cut.h5", test::made_up_run(), {});
  const auto size = std::filesystem::file_size(folder / "cut.h5");
  std::filesystem::resize_file(folder / "cut.h5", size / 2);
  CHECK(contains(message_of([&] { read_results(folder / "cut.h5"); }), "truncated file"));
}

TEST_CASE("A result whose parts contradict each other is refused") {
  const auto folder = test::scratch_folder("results_contradiction");
  RunResult run = test::made_up_run();
  run.points[0].absorbed_in_medium.pop_back();
  write(folder / "media.h5", run, {});
  check_contains(message_of([&] { read_results(folder / "media.h5"); }),
                 {"absorbed_in_medium", "not match", "media"});
  run = test::made_up_run();
  run.points[1].sensor_faces[0].face = FaceId(3);
  write(folder / "face.h5", run, {});
  const auto message = message_of([&] { read_results(folder / "face.h5"); });
  CHECK(contains(message, "in point 0001"));
  check_contains(message, {"face", "not exist"});
}

TEST_CASE("A result with impossible numbers is refused with what is wrong") {
  const auto folder = test::scratch_folder("results_impossible");
  const auto refused = [&](const auto& change) {
    RunResult run = test::made_up_run();
    change(run.points[1]);
    write(folder / "run.h5", run, {});
    return message_of([&] { read_results(folder / "run.h5"); });
  };
  check_contains(refused([](PointResult& p) { p.photons = 7; }), {"point 0001", "fates"});
  check_contains(refused([](PointResult& p) { p.fates[0] += 1ULL << 62; }), {"point 0001", "fates"});
  check_contains(refused([](PointResult& p) { p.absorbed_at_surface[core::SurfaceId(0)] += 1; }),
                 "absorbed_at_surface");
  check_contains(refused([](PointResult& p) { p.sensor_faces[0].detected += 1; }), "sensor_faces");
  check_contains(refused([](PointResult& p) { p.interactions.sum = NAN; }), "interactions_per_photon");
  check_contains(refused([](PointResult& p) { p.detected_path_mm.sum *= 1e9; }), "detected_path");
  check_contains(refused([](PointResult& p) { p.wall_seconds = -1.0; }), "wall_seconds");
  const auto endless = [](PointResult& p) {
    TallyResult tally;
    tally.name = "seen";
    tally.type = "count";
    tally.score = "photons";
    tally.unit = "1";
    tally.sum = {1.0};
    tally.sum_of_squares = {INFINITY};
    p.tallies.push_back(tally);
  };
  check_contains(refused(endless), "sum of squares");
  CHECK(refused([](PointResult&) {}).empty());
}

TEST_CASE("A list of three million photons streams through bounded memory") {
#ifdef SCINTRAY_SANITIZED
  MESSAGE("[skipped] the address sanitizer keeps freed memory, so the program's own cannot be measured");
  return;
#endif
  const auto path = test::scratch_folder("results_stream") / "run.h5";
  const auto resident_kb = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const RunResult run = test::made_up_run();
  const auto block = made_up_photons(10'000);
  ResultsWriter writer(path, run.header, true);
  writer.append_photons(made_up_photons(100'000));
  const long before = resident_kb();
  for (int i = 0; i < 290; ++i) writer.append_photons(block);
  writer.commit(true);
  CHECK(resident_kb() - before < 60'000);
  CHECK(read_results_status(path).listed_photons == 3'000'000);
  CHECK(same(read_photons(path, 2'999'999, 1).at(0), block.back()));
  std::filesystem::remove(path);
}

TEST_CASE("docs/results.md names every dataset, group and attribute of a file, and each is described") {
  const auto path = test::scratch_folder("results_documented") / "run.h5";
  RunResult run = test::made_up_run();
  run.points.resize(1);
  run.points.front().light_timing = LightTiming{{{40.0, 0.1, 0.7}, {10.0, 0.0, 0.3}}, 0.12};
  run.points.front().omitted =
      std::vector<OmittedEffect>{{"time spread", "R6231", "[transit_time]", false, true, false},
                                 {"reflection", "", "", true, false, true}};
  {
    ResultsWriter writer(path, run.header, true);
    const HistorySubjects subjects{
        {"LSO"}, {{0.001, 0.002}}, {{"wrapped", "wrapped", "PTFE"}}, {{0.9, 0.95}}, {}, {}};
    HistoryColumns columns;
    columns.add(subjects);
    writer.begin_paths();
    writer.append_paths(
        0, {{3, 4, Fate::escaped, {{{1, 2, 3}, 0.0, 420.0, "emitted"}, {{1, 2, 4}, 0.5, 420.0, "escaped"}}}});
    writer.begin_histories(columns);
    writer.append_photons(made_up_photons(10));
    writer.append_histories({{0}, {1}, {2}, {30.0f}, {0.1f}, {4}, {0.3f}}, subjects);
    const test::MadeUpDetector detector;
    const EventAnalysis events = analyze_events(detector.events(3000, true), detector.setup());
    writer.add_point(run.points.front(), &subjects, &events);
    writer.commit(true);
  }
  const auto timing = read_results(path).points.front().light_timing;
  REQUIRE(timing);
  CHECK(timing->time_spread_ns == 0.12);
  REQUIRE(timing->decay.size() == 2);
  CHECK((timing->decay[1].decay_ns == 10.0 && timing->decay[1].rise_ns == 0.0 &&
         timing->decay[1].fraction == 0.3));
  const auto omitted = read_results(path).points.front().omitted;
  REQUIRE(omitted);
  REQUIRE(omitted->size() == 2);
  CHECK((omitted->at(0).effect == "time spread" && omitted->at(0).subject == "R6231" &&
         omitted->at(0).remedy == "[transit_time]" && omitted->at(1).subject.empty()));
  CHECK((!omitted->at(0).in_resolution && omitted->at(0).in_timing && !omitted->at(0).in_fraction));
  CHECK((omitted->at(1).in_resolution && !omitted->at(1).in_timing && omitted->at(1).in_fraction));
  const std::string document = text_of(test::source_file("docs/results.md"));
  const h5::File file = h5::File::open(path);
  int datasets = 0;
  const std::function<void(const h5::Group&)> visit = [&](const h5::Group& group) {
    const auto check_attributes = [&](const std::string& member) {
      for (const std::string& attribute : group.attributes(member)) {
        CAPTURE(attribute);
        CHECK(contains(document, "`" + attribute + "`"));
      }
    };
    check_attributes("");
    for (const std::string& name : group.members()) {
      CAPTURE(name);
      check_attributes(name);
      if (name != "0001") CHECK(contains(document, name));
      try {
        visit(group.open_group(name));
      } catch (const SystemError&) {  // a dataset
        ++datasets;
        CHECK(group.string_attribute(name, "description").size() > 5);
        CHECK(group.has_attribute(name, "unit"));
        CHECK(contains(document, "`" + name + "`"));
      }
    }
  };
  visit(file.root());
  CHECK(datasets > 120);
}

TEST_CASE("Every dimension has a scale, swept values are numbers, and rows are signed") {
  const auto path = test::scratch_folder("results_scales") / "run.h5";
  const RunResult run = test::made_up_run();
  {
    ResultsWriter writer(path, run.header, true);
    writer.append_photons(made_up_photons(10'000));  // more than a block
    writer.begin_paths();
    writer.append_paths(
        0, {{3, 4, Fate::escaped, {{{1, 2, 3}, 0.0, 420.0, "emitted"}, {{1, 2, 4}, 0.5, 420.0, "escaped"}}}});
    writer.begin_events(0, {}, {});
    EventRecord event;
    event.event = 7;
    writer.append_events({event, event});
    for (const PointResult& point : run.points) writer.add_point(point);
    writer.commit(true);
  }
  const h5::File file = h5::File::open(path);
  const h5::Group root = file.root();
  int dimensions = 0;
  const std::function<void(const h5::Group&)> visit = [&](const h5::Group& group) {
    for (const std::string& name : group.members()) {
      CAPTURE(name);
      if (!group.has_dataset(name)) {
        visit(group.open_group(name));
        continue;
      }
      for (unsigned k = 0; k < group.shape(name).size(); ++k, ++dimensions) CHECK(group.has_scale(name, k));
    }
  };
  visit(root);
  CHECK(dimensions > 500);
  const std::vector<std::int64_t> rows = root.open_group("photons").read<std::int64_t>("row");
  REQUIRE(rows.size() == 10'000);
  for (std::size_t i = 0; i < rows.size(); ++i) REQUIRE(rows[i] == static_cast<std::int64_t>(i));
  // Signed in the file: -1 is stored as it is, where an unsigned dataset would refuse it.
  for (const char* name : {"event", "first_signal", "photons_emitted", "photons_detected"})
    CHECK(root.open_group("events").read<std::int64_t>(name).size() == 2);
  CHECK(read_events(path, 0, 5).at(1).event == 7);

  const h5::Group first = root.open_group("points/0000");
  const std::vector<double> values = first.read<double>("parameter_value");
  REQUIRE(values.size() == 2);
  CHECK(std::isnan(values[0]));  // "polished"
  CHECK(values[1] == 2.0);
  CHECK(first.read_strings("parameter_unit") == std::vector<std::string>{"", "mm"});
  const h5::Group sweep = root.open_group("sweep");
  CHECK(sweep.shape("parameter_value") == h5::Shape{15, 2});
  CHECK(sweep.read<double>("parameter_value")[29] == 18.0);
  const std::vector<double> fractions = sweep.read<double>("fate_fraction");
  CHECK(fractions.at(14 * kFateCount) == run.points[14].fraction(Fate::detected).value);
}

TEST_CASE("xarray opens the groups of a result, and NumPy counts by its columns") {
  if (std::system("/usr/bin/python3 -c 'import xarray, h5netcdf' 2>/dev/null") != 0) {
    MESSAGE("[skipped] no xarray with h5netcdf");
    return;
  }
  const auto folder = test::scratch_folder("results_xarray");
  const RunResult run = test::made_up_run();
  {
    const test::MadeUpDetector detector;
    const std::vector<EventRecord> events = detector.events(2000, true);
    const EventAnalysis analysis = analyze_events(events, detector.setup());
    std::vector<ReadoutChannel> channels(events.front().channels.size());
    for (ReadoutChannel& channel : channels) channel.part = PartId(1);
    ResultsWriter writer(folder / "run.h5", run.header, true);
    writer.append_photons(made_up_photons(5));
    writer.begin_events(0, channels, {});
    writer.append_events(events);
    for (const PointResult& point : run.points) writer.add_point(point, nullptr, &analysis);
    writer.commit(true);
  }
  std::ofstream(folder / "read.py") << R"python(
import sys
import numpy
import xarray

def opened(group):
    return xarray.open_dataset(sys.argv[1], group=group, engine="h5netcdf")

events, signals = opened("events"), opened("signals")
light = numpy.bincount(signals["event_row"].values, weights=signals["charge"].values, minlength=events.sizes["row"])
print("light", len(light), light.sum() > 0)
print("counted", numpy.bincount(events["photons_detected"].values).sum() == events.sizes["row"])
sweep = opened("sweep")
detected = sweep["fate_fraction"].sel(fate="detected")
print("sweep", detected.dims, detected.sizes["row"], sweep["parameter_value"].sel(swept_key="source.region.slab_z.center").values[1])
for group in ("/", "photons", "points/0003", "points/0003/analysis", "points/0003/analysis/flood_map/peaks"):
    print(group, len(opened(group).variables) > 3)
)python";
  const std::string command = "/usr/bin/python3 \"" + (folder / "read.py").string() + "\" \"" +
                              (folder / "run.h5").string() + "\" > \"" + (folder / "out.txt").string() +
                              "\" 2>&1";
  const int status = std::system(command.c_str());
  const std::string output = text_of(folder / "out.txt");
  CAPTURE(output);
  CHECK(status == 0);
  CHECK(contains(output, "light 2000 True"));
  CHECK(contains(output, "counted True"));
  CHECK(contains(output, "sweep ('row',) 15 6.0"));
  for (const char* group : {"/ ", "photons ", "points/0003 ", "points/0003/analysis ", "peaks "})
    CHECK(contains(output, std::string(group) + "True"));
}

TEST_CASE("The Python example of docs/results.md reads a result with h5py") {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) {
    MESSAGE("[skipped] no h5py");
    return;
  }
  const auto folder = test::scratch_folder("results_python");
  RunResult run = test::made_up_run();
  run.partial_reason = "interrupted";
  write(folder / "run.h5", run, made_up_photons(5));
  const std::string document = text_of(test::source_file("docs/results.md"));
  const auto start = document.find("```python\n") + 10;
  std::ofstream(folder / "example.py") << document.substr(start, document.find("```", start) - start);
  const std::string command = "/usr/bin/python3 \"" + (folder / "example.py").string() + "\" \"" +
                              (folder / "run.h5").string() + "\" > \"" + (folder / "out.txt").string() +
                              "\" 2>&1";
  const int status = std::system(command.c_str());
  const std::string output = text_of(folder / "out.txt");
  CAPTURE(output);
  CHECK(status == 0);
  CHECK(contains(output, run.header.title + " partial: interrupted"));
  CHECK(contains(output, "0014 ground, UNIFIED 18 mm"));
  CHECK(contains(output, "  detected             0.45"));
  CHECK(contains(output, "5 photons, mean time 0.002 ns"));
}

TEST_CASE("Surfaces measured on the goniometer are read back from the file") {
  const auto path = test::scratch_folder("results_benches") / "run.h5";
  SurfaceAnalysis smooth = test::made_up_surface("unified", "grease");
  smooth.slope_rad.clear();
  const std::vector<SurfaceAnalysis> written{test::made_up_surface("ground", "air"), smooth};
  const RunResult run = test::made_up_run();
  ResultsWriter writer(path, run.header, false);
  writer.add_surfaces(written);
  for (const PointResult& point : run.points) writer.add_point(point);
  writer.commit(true);
  const std::vector<SurfaceAnalysis> read = read_surfaces(path);
  REQUIRE(read.size() == 2);
  const SurfaceAnalysis &a = read[0], &b = written[0];
  CHECK(a.goniometer == b.goniometer);
  CHECK(a.place.surface == "ground");
  CHECK(a.place.inside == "LSO");
  CHECK(a.place.outside == "air");
  CHECK(a.place.wavelength_nm == 420.0);
  CHECK(a.index.inside == 1.82);
  CHECK(a.index.outside == 1.0);
  CHECK(a.rays == 1000);
  REQUIRE(a.incidence_rad.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(a.incidence_rad[i] == doctest::Approx(b.incidence_rad[i]).epsilon(1e-14));
    CHECK(a.reflectance[i].value == b.reflectance[i].value);
    CHECK(a.reflectance[i].error == b.reflectance[i].error);
    CHECK(a.slope_rad[i].value == doctest::Approx(b.slope_rad[i].value).epsilon(1e-14));
    CHECK(a.slope_rad[i].error == doctest::Approx(b.slope_rad[i].error).epsilon(1e-14));
  }
  CHECK(a.directions.settings.incidence_rad == doctest::Approx(45.0 * kDegree));
  CHECK(a.directions.settings.rays == 1000);
  CHECK(a.directions.reflected == 800);
  CHECK(a.directions.transmitted == 190);
  CHECK(a.directions.absorbed == 10);
  CHECK(a.directions.reflected_directions.cells == b.directions.reflected_directions.cells);
  CHECK(a.directions.reflected_directions.profile == b.directions.reflected_directions.profile);
  CHECK(a.directions.transmitted_directions.cells == b.directions.transmitted_directions.cells);
  CHECK(a.directions.transmitted_directions.profile == b.directions.transmitted_directions.profile);
  CHECK(a.directions.reflected_lobe.width_in_plane == 0.5);
  CHECK(read[1].slope_rad.empty());
  CHECK(read[1].place.outside == "grease");
}
