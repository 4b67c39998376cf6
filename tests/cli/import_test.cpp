#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "cli/program.hpp"
#include "io/gdml_texts.hpp"
#include "scintray/core/h5.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void check_contains(const Ended& ended, int exit_code, const Fragments& fragments) {
  CAPTURE(ended.output);
  CHECK(ended.exit_code == exit_code);
  check_contains(ended.output, fragments);
}

/// Two bodies of one triangle each is enough to tell them apart.
constexpr const char* kTwoBodies =
    "o left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no right\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 4 5 6\n";

}  // namespace

TEST_CASE("import makes a scene of a GDML file that check and run accept") {
  const auto folder = scratch_folder("cli_import_gdml");
  write(folder / "detector.gdml", gdml_solid(R"(<tube name="it" rmax="5" z="10" deltaphi="twopi"/>)").text());
  check_contains(run_program({"import", "detector.gdml", "-o", "out"}, folder), 0,
                 "wrote out/scene.toml and 1 meshes");
  CHECK(std::filesystem::exists(folder / "out/scene_meshes/it.ply"));
  check_contains(run_program({"check", "out/scene.toml"}, folder), 0, "no errors in 1 point");
  const std::string scene = read(folder / "out/scene.toml");
  write(folder / "out/scene.toml",
        scene.substr(0, scene.find("10_000")) + "100" + scene.substr(scene.find("10_000") + 6));
  check_contains(run_program({"run", "out/scene.toml", "-o", "out.h5"}, folder), 0, "escaped");
  // A second import must not destroy what was edited.
  check_contains(run_program({"import", "detector.gdml", "-o", "out"}, folder), 1, {"scene file", "already"});
}

TEST_CASE("import makes a part of each body, and check names what is left to fill in") {
  const auto folder = scratch_folder("cli_import_model");
  write(folder / "two.obj", kTwoBodies);
  check_contains(run_program({"import", "two.obj", "-o", "two.toml"}, folder), 1,
                 {"unit = \"mm\"", "--unit mm"});
  check_contains(run_program({"import", "two.obj", "--unit", "inch", "-o", "two.toml"}, folder), 0,
                 {"medium", "surface", "every part"});
  const std::string scene = read(folder / "two.toml");
  CHECK(contains(scene, "name = \"left\"\nmesh = \"two.obj\"\nbody = \"left\"\nunit = \"inch\""));
  CHECK(contains(scene, "body = \"right\""));
  const Ended checked = run_program({"check", "two.toml"}, folder);
  check_contains(checked, 1, "[part] has no \"medium\"");
  check_contains(checked, 1, "has no \"source\"");
  check_contains(checked, 1, "has no \"ambient\"");
}

TEST_CASE("export writes a scene as GDML that import reads, and refuses other endings") {
  const auto folder = scratch_folder("cli_export");
  write(folder / "d.gdml", gdml_solid(R"(<box name="it" x="1" y="1" z="1"/>)").text());
  REQUIRE(run_program({"import", "d.gdml", "-o", "one.toml"}, folder).exit_code == 0);
  check_contains(run_program({"export", "one.toml", "-o", "one.gdml"}, folder), 0, "wrote one.gdml");
  check_contains(run_program({"import", "one.gdml", "-o", "two.toml"}, folder), 0, "wrote two.toml");
  check_contains(run_program({"check", "two.toml"}, folder), 0, "no errors");
  check_contains(run_program({"export", "one.toml", "-o", "one.step"}, folder), 1,
                 {"one.step", "exported as GDML"});
}

TEST_CASE("export writes the rows of a result as CSV, NumPy and LH5, which a list of photons reads") {
  const auto folder = scratch_folder("cli_export_rows");
  const std::string scene = R"(ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "R6231"
[run]
photon_list = true
)";
  write(folder / "a.toml", scene + R"([source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 500
)");
  REQUIRE(run_program({"run", "a.toml", "-o", "a.h5", "--no-report"}, folder).exit_code == 0);
  for (const char* name : {"rows.csv", "rows.npy", "rows.lh5"})
    check_contains(run_program({"export", "a.h5", "-o", name}, folder), 0, {"rows of photons", name});
  const std::string csv = read(folder / "rows.csv");
  CHECK(csv.starts_with("point,event,photon,part,face,x_mm,y_mm,z_mm,direction_x"));
  const auto rows = std::count(csv.begin(), csv.end(), '\n') - 1;
  CHECK(rows > 10);
  CHECK(contains(read(folder / "rows.npy"), "'shape': (" + std::to_string(rows) + ",)"));
  const core::h5::File lh5 = core::h5::File::open(folder / "rows.lh5");
  const core::h5::Group photons = lh5.root().open_group("photons");
  CHECK(photons.string_attribute("", "datatype").starts_with("table{point,event,photon,"));
  CHECK(photons.string_attribute("time_ns", "datatype") == "array<1>{real}");
  CHECK(photons.string_attribute("time_ns", "units") == "ns");
  CHECK_FALSE(photons.has_attribute("event", "units"));
  CHECK(photons.shape("x_mm") == core::h5::Shape{static_cast<std::uint64_t>(rows)});
  // The three are one source.
  std::string first;
  for (const std::string more :
       {"file = \"rows.csv\"", "file = \"rows.npy\"", "file = \"rows.lh5\"\ngroup = \"photons\""}) {
    write(folder / "b.toml", R"(ambient = "air"
[[part]]
name = "guide"
box = { low = ["-1 mm", "-1 mm", "-8 mm"], high = ["1 mm", "1 mm", "0 mm"] }
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "guide", side = "-z" }
sensor = "R6231"
[run]
photon_list = true
[source]
type = "photon_list"
)" + more + R"(
length_unit = "mm"
wavelength_unit = "nm"
time_unit = "ns"
columns = { x = "x_mm", y = "y_mm", z = "z_mm", wavelength = "wavelength_nm", time = "time_ns" }
)");
    check_contains(run_program({"run", "b.toml", "-o", "b.h5", "--no-report"}, folder), 0, "1 events");
    const core::h5::File result = core::h5::File::open(folder / "b.h5");
    std::string times;
    for (const double ns : result.root().open_group("photons").read<double>("time_ns"))
      times += std::to_string(ns) + "\n";
    if (first.empty()) first = times;
    CHECK(times == first);
    remove(folder / "b.h5");
  }
  check_contains(run_program({"export", "a.h5", "-o", "a.root"}, folder), 1,
                 {"a.root", ".csv, .npy or .lh5"});
  const Ended no_table = run_program({"export", "a.h5", "--table", "hits", "-o", "a.csv"}, folder);
  check_contains(no_table, 1, "no table \"hits\"");
  check_contains(no_table, 1, {"it has", "photons"});
}

TEST_CASE("import explains options that do not fit") {
  const auto folder = scratch_folder("cli_import_options");
  write(folder / "two.obj", kTwoBodies);
  write(folder / "d.gdml", gdml_solid(R"(<box name="it" x="1" y="1" z="1"/>)").text());
  check_contains(run_program({"import", "two.obj", "-o", "x", "--medium", "A=b"}, folder), 1,
                 "are for GDML files");
  check_contains(run_program({"import", "d.gdml", "-o", "x", "--unit", "mm"}, folder), 1, {"--unit", "GDML"});
  check_contains(run_program({"import", "d.gdml", "-o", "x", "--medium", "Air"}, folder), 1,
                 "of the form NAME=NAME");
  check_contains(run_program({"import", "d.gdml", "-o", "x", "--medium", "Air=air"}, folder), 1,
                 "does not have");
  check_contains(run_program({"import", "d.gdml", "-o", "x", "--angle", "200 deg"}, folder), 1,
                 {"0.1", "90 deg"});
  write(folder / "Surfaces.xml", "<surfaces/>");
  check_contains(run_program({"import", "Surfaces.xml", "-o", "x"}, folder), 1,
                 {"Surfaces.xml", "no entries"});
  write(folder / "Materials.db", "[Elements]\n");
  check_contains(run_program({"import", "Materials.db", "-o", "x"}, folder), 1,
                 {"Materials.db", "densities and compositions"});
  check_contains(run_program({"import", "gone.gdml", "-o", "x"}, folder), 1,
                 {"gone.gdml", "there is no such file"});
  check_contains(run_program({"import", "gone.gdml", "-o", "x"}, folder), 1, "[file-missing]");
  CHECK_FALSE(std::filesystem::exists(folder / "x"));
}

// Peak memory is measured, not limited: what a library takes at its start would count against a limit. A
// crash is exit code -1, a hang runs into the time limit of the test.
TEST_CASE("no file of the reference collections makes the program crash, hang or take memory without bound") {
#ifdef SCINTRAY_SANITIZED
  constexpr long kKibPerByte = 4, kAlways_kib = 512 * 1024;  // shadow memory, red zones and what is freed
#else
  constexpr long kKibPerByte = 1, kAlways_kib = 64 * 1024;
#endif
  const auto collections = shared_file("data/meshes");
  if (!collections) return;
  const auto folder = scratch_folder("cli_import_malformed");
  const long nothing_kib = run_program({"--version"}, folder).peak_kib;
  int number = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*collections)) {
    if (!entry.is_regular_file()) continue;
    CAPTURE(entry.path().string());
    std::vector<std::string> words{"import", entry.path().string(), "-o", std::to_string(++number)};
    const std::string ending = entry.path().extension().string();
    if (contains("STL .stl .obj .ply .off .OFF", ending)) words.insert(words.end(), {"--unit", "mm"});
    const Ended ended = run_program(words, folder);
    CAPTURE(ended.output);
    CHECK((ended.exit_code == 0 || ended.exit_code == 1));
    // Refused: with the file's name. A library's own words are not enough.
    if (ended.exit_code == 1) CHECK(contains(ended.output, entry.path().filename().string()));
    CHECK(ended.peak_kib < nothing_kib + kAlways_kib + kKibPerByte * static_cast<long>(entry.file_size()));
  }
  CHECK(number >= 42);
}
