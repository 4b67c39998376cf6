#include <doctest/doctest.h>

#include <fstream>

#include "cli/program.hpp"
#include "io/gdml_texts.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

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
  check_contains(run_program({"import", "gone.gdml", "-o", "x"}, folder), 1, "mesh file not found");
  CHECK_FALSE(std::filesystem::exists(folder / "x"));
}

// Peak memory is measured, not limited: what a library takes at its start would count against a limit. A
// crash is exit code -1, a hang runs into the time limit of the test.
TEST_CASE("no file of the reference collections makes the program crash, hang or take memory without bound") {
#if defined(__SANITIZE_ADDRESS__)
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
