#include <cmath>
#include <fstream>

#include "event_scene.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/source/detail/event_sources.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

std::filesystem::path file_with(const std::string& csv) {
  const std::filesystem::path file = scratch_folder("hits") / "hits.csv";
  std::ofstream(file) << csv;
  return file;
}

std::string source_of(const std::filesystem::path& file, const std::string& more = "time_unit = \"ns\"") {
  return "type = \"hits\"\nfile = \"" + file.string() + "\"\nlength_unit = \"cm\"\nenergy_unit = \"MeV\"\n" +
         more;
}

std::string hits_refused(const std::string& csv) {
  const Scene scene = lso_cube(10.0);
  return complaint([&] { event_source(source_of(file_with(csv)), scene); });
}

}  // namespace

TEST_CASE("hits become events in the order of their numbers, in our units") {
  const Scene scene = lso_cube(10.0);
  std::vector<std::string> notes;
  const auto source = event_source(
      source_of(
          file_with("event,x,y,z,energy,time\n7,0.1,0,0,0.3,105\n7,0,0.2,0,0.2,104\n9,0,0,0.3,0.511,2\n")),
      scene, &notes);
  CHECK(notes.empty());
  REQUIRE(source->events() == 2);
  const Event first = make_event(*source, scene, 0);
  REQUIRE(first.deposits.size() == 2);
  CHECK(first.deposits[0].position.isApprox(Vec3(1.0, 0.0, 0.0)));
  CHECK(first.deposits[0].energy_keV == doctest::Approx(300.0));
  CHECK(first.deposits[0].time_ns == doctest::Approx(1.0));
  CHECK(first.deposits[1].time_ns == 0.0);
  CHECK(first.energy_keV == 0.0);
  CHECK(deposited_keV(make_event(*source, scene, 1)) == doctest::Approx(511.0));
}

TEST_CASE("hits out of order and outside are counted and the first named") {
  const Scene scene = lso_cube(10.0);
  std::vector<std::string> notes;
  const auto source = event_source(
      source_of(file_with("event,x,y,z,energy\n1,0,0,0,0.1\n2,0,0,0,0.2\n1,0,0,0,0.3\n2,5,0,0,0.4\n"), ""),
      scene, &notes);
  REQUIRE(source->events() == 2);
  CHECK(deposited_keV(make_event(*source, scene, 0)) == doctest::Approx(400.0));
  const Event second = make_event(*source, scene, 1);
  CHECK(deposited_keV(second) == doctest::Approx(200.0));
  CHECK(second.non_scintillating_keV == doctest::Approx(400.0));
  REQUIRE(notes.size() == 2);
  CHECK(says(notes[0], "1 of 4 hits lie outside every part"));
  CHECK(says(notes[0], "row 5 (event 2, at 50, 0, 0 mm)"));
  CHECK(says(notes[1], "2 of 4 hits came after"));
}

TEST_CASE("columns have the names of the scene, and events can be limited") {
  const Scene scene = lso_cube(10.0);
  const auto source = event_source(
      source_of(
          file_with("EventID,PosX,PosY,PosZ,Edep,GlobalTime\n1,0,0,0,0.1,5\n2,0,0,0,0.2,5\n"),
          "time_unit = \"us\"\nevents = 1\ncolumns = { event = \"EventID\", x = \"PosX\", y = \"PosY\", z = "
          "\"PosZ\", energy = \"Edep\", time = \"GlobalTime\" }"),
      scene);
  CHECK(source->events() == 1);
}

TEST_CASE("HDF5 columns are read as CSV columns are") {
  const Scene scene = lso_cube(10.0);
  const std::filesystem::path path = scratch_folder("hits_h5") / "hits.h5";
  const auto write = [&](const std::vector<double>& energy) {
    h5::File file = h5::File::create(path);
    h5::Group group = file.root().create_group("hits");
    group.write<std::int64_t>("event", {0, 0, 3});
    for (const char* axis : {"x", "y", "z"}) group.write<double>(axis, {0.0, 0.1, 0.2});
    group.write<double>("energy", energy);
    file.commit();
  };
  write({0.1, 0.2, 0.3});
  const auto source = event_source(source_of(path, "group = \"hits\""), scene);
  REQUIRE(source->events() == 2);
  CHECK(deposited_keV(make_event(*source, scene, 0)) == doctest::Approx(300.0));
  CHECK(says(complaint([&] { event_source(source_of(path, "group = \"hit\""), scene); }), "hits"));
  CHECK(says(complaint([&] { event_source(source_of(path, "group = \"hits\"\ntime_unit = \"ns\""), scene); }),
             "\"time\""));
  write({0.1, 0.2});
  CHECK(says(complaint([&] { event_source(source_of(path, "group = \"hits\""), scene); }),
             "not a column as long"));
  write({0.1, -0.2, 0.3});
  CHECK(says(complaint([&] { event_source(source_of(path, "group = \"hits\""), scene); }),
             "row 1: the energy -0.2"));
}

TEST_CASE("files that are no lists of hits are refused") {
  CHECK(says(hits_refused("event,x,y,z,energy,time\n1.5,0,0,0,1,0\n-1,0,0,0,1,0\n"), "hits.csv:2"));
  CHECK(says(hits_refused("event,x,y,z,energy,time\n1,0,0,0,-1,0\n"), "the energy -1"));
  CHECK(says(hits_refused("event,x,y,z,energy\n1,0,0,0,1\n"), "no column \"time\""));
  CHECK(says(hits_refused("event,x,y,z,energy,time\n1,900,0,0,1,0\n"), "none of the 1 hits"));
  CHECK(says(hits_refused("event,x,y,z,energy,time\n"), "no rows"));
  CHECK(says(complaint([&] { gamma_spec("type = \"hits\"\nfile = \"nowhere.csv\"\nlength_unit = \"keV\""); }),
             "nowhere.csv"));
  CHECK(says(complaint([&] { gamma_spec(source_of(file_with("event\n1\n"), "columns = { time = \"t\" }")); }),
             "without their unit"));
  CHECK(
      says(complaint([&] { gamma_spec(source_of(file_with("event\n1\n"), "group = \"x\"")); }), "no groups"));
}

TEST_CASE("hits in memory are those of a file with the same numbers") {
  const Scene scene = lso_cube(10.0);
  const auto from_file = event_source(
      source_of(
          file_with("event,x,y,z,energy,time\n4,0.1,0.2,0.3,0.511,7\n4,-0.1,0,0,0.1,9\n2,0,0,0,0.3,1\n")),
      scene);
  scene_file::GammaSpec spec = gamma_spec("type = \"hits\"\narrays = true");
  auto& hits = std::get<scene_file::HitsSpec>(spec.kind);
  CHECK(says(complaint([&] { make_event_source(spec, scene); }), "did not set them"));
  hits.columns = std::make_shared<const scene_file::HitColumns>(
      scene_file::HitColumns{{4, 4, 2}, {1, -1, 0}, {2, 0, 0}, {3, 0, 0}, {511, 100, 300}, {7, 9, 1}});
  const auto from_memory = make_event_source(spec, scene);
  REQUIRE(from_memory->events() == from_file->events());
  for (std::uint64_t number = 0; number < 2; ++number) {
    const Event a = make_event(*from_file, scene, number), b = make_event(*from_memory, scene, number);
    REQUIRE(a.deposits.size() == b.deposits.size());
    for (std::size_t i = 0; i < a.deposits.size(); ++i) {
      CHECK((a.deposits[i].position - b.deposits[i].position).norm() < 1e-12);
      CHECK(a.deposits[i].energy_keV == doctest::Approx(b.deposits[i].energy_keV));
      CHECK(a.deposits[i].time_ns == b.deposits[i].time_ns);
    }
  }
}

TEST_CASE("hits in memory that are wrong are refused with their row") {
  const Scene scene = lso_cube(10.0);
  const auto refused = [&](scene_file::HitColumns columns) {
    scene_file::GammaSpec spec = gamma_spec("type = \"hits\"\narrays = true");
    std::get<scene_file::HitsSpec>(spec.kind).columns =
        std::make_shared<const scene_file::HitColumns>(std::move(columns));
    return complaint([&] { make_event_source(spec, scene); });
  };
  CHECK(says(refused({{0, 1}, {0}, {0, 0}, {0, 0}, {1, 1}, {}}), "differ in length: 2 and 1"));
  CHECK(says(refused({{0, 1.5}, {0, 0}, {0, 0}, {0, 0}, {1, 1}, {}}), "row 1"));
  CHECK(says(refused({{0}, {std::nan("")}, {0}, {0}, {1}, {}}), "not finite"));
  CHECK(says(refused({{}, {}, {}, {}, {}, {}}), "the calling program"));
  CHECK(says(complaint([] { gamma_spec("type = \"hits\"\narrays = true\nfile = \"README.md\""); }), "file"));
}
