#include "program.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/export/gltf_writer.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

// `scintray check` and `scintray repair` as a user runs them.

namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

/// A box of 2 x 2 x 2 mm without one of its triangles.
TriMesh box_with_hole() {
  TriMesh mesh = make_box({0, 0, 0}, {2, 2, 2});
  mesh.triangles.pop_back();
  mesh.group.pop_back();
  return mesh;
}

const std::string kSource = R"(
[source]
type = "photons"
position = ["1 mm", "1 mm", "1 mm"]
wavelength = "420 nm"
photons = 10
)";

/// 64 crystals under a guide, made of crystal[i,j] as builders of arrays name them.
std::string array_scene() {
  std::ostringstream text;
  text << "ambient = \"air\"\n";
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      text << "[[part]]\nname = \"crystal[" << i << "," << j
           << "]\"\nmedium = \"LSO\"\nsurface = \"polished\"\n"
           << "box = [\"2 mm\", \"2 mm\", \"10 mm\"]\ntranslate = [\"" << 2.5 * i << " mm\", \"" << 2.5 * j
           << " mm\", \"0 mm\"]\n";
  text << "[[part]]\nname = \"guide\"\nmedium = \"glass\"\nsurface = \"polished\"\n"
       << "box = { low = [\"-2 mm\", \"-2 mm\", \"10 mm\"], high = [\"20 mm\", \"20 mm\", \"13 mm\"] }\n";
  return text.str() + kSource;
}

}  // namespace

TEST_CASE("check prints that 64 crystals touch their guide, in one line, and with --all in 64") {
  const auto folder = scratch_folder("check_array");
  write(folder / "array.toml", array_scene());
  const Ended brief = run_program({"check", "array.toml"}, folder);
  CHECK(brief.exit_code == 0);
  CHECK(contains(brief.output, "crystal[*] | guide: 64 interfaces (64 bonded), 256 mm2"));
  CHECK(contains(brief.output, "crystal[*] x 64"));
  CHECK(std::count(brief.output.begin(), brief.output.end(), '\n') < 40);
  const Ended all = run_program({"check", "array.toml", "--all"}, folder);
  CHECK(contains(all.output, "crystal[7,3] | guide: 1 interface (1 bonded), 4 mm2"));
  CHECK(std::count(all.output.begin(), all.output.end(), '\n') > 64 * 5);
}

TEST_CASE("check marks the places of problems in a picture, also when the scene does not build") {
  const auto folder = scratch_folder("check_picture");
  write_stl(folder / "open.stl", box_with_hole());
  write(folder / "bad.toml",
        "ambient = \"air\"\n"
        "[[part]]\nname = \"crystal\"\nmesh = \"open.stl\"\nunit = \"mm\"\nmedium = \"LSO\"\n"
        "surface = \"polished\"\n"
        "[[part]]\nname = \"bare\"\nbox = [\"1 mm\", \"1 mm\", \"1 mm\"]\nmedium = \"glass\"\n"
        "translate = [\"5 mm\", \"0 mm\", \"0 mm\"]\n"
        "[[part.face]]\nselect = { normal = [0, 0, 1] }\nsurface = \"polished\"\n"
        "[[part.face]]\nname = \"top\"\nselect = { nearest = [\"5 mm\", \"0 mm\", \"1 mm\"] }\nsurface = "
        "\"polished\"\n" +
            kSource);
  for (const char* picture : {"bad.svg", "bad.glb"}) {
    CAPTURE(picture);
    const Ended ended = run_program({"check", "bad.toml", "--picture", picture}, folder);
    CHECK(ended.exit_code == 1);
    check_contains(ended.output, {"\"crystal\"", "3 open edges"});
    check_contains(ended.output, {"medium", "is not defined"});
    check_contains(ended.output, {"\"bare\"", "without a surface"});
    check_contains(ended.output, {"\"+z\"", "\"top\"", "\"bare\"", "triangle at"});
    CHECK(contains(ended.output, "parts: 2, marked problems: 3"));
    CHECK(std::filesystem::file_size(folder / picture) > 1000);
  }
  const std::string svg = content(folder / "bad.svg");
  check_contains(svg, {"&quot;crystal&quot;", "3 open edges"});
  // Each of the three views has a ring for every place: 3 open edges, 1 bare face, 1 face of two rules,
  // some on one spot; and the legend one for each problem.
  std::size_t rings = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
    ++rings;
  CHECK(rings >= 3 + 3 * 3);
  const MeshImport glb = import_mesh(folder / "bad.glb", 0.0);
  CHECK(glb.mesh.triangles.size() == 11 + 12 + 5 * 180);

  const Ended other = run_program({"check", "bad.toml", "--picture", "bad.jpeg"}, folder);
  CHECK(other.exit_code == 1);
  check_contains(other.output, {".glb", ".svg"});
}

TEST_CASE("repair mends a mesh, prints each repair and its place, and returns 0") {
  const auto folder = scratch_folder("repair_mesh");
  write_stl(folder / "open.stl", box_with_hole());
  const Ended ended = run_program(
      {"repair", "open.stl", "--unit", "mm", "--largest-hole", "3 mm", "-o", "closed.stl"}, folder);
  CHECK(ended.exit_code == 0);
  CHECK(contains(ended.output, "found: 11 triangles, 1 body, 22 mm2, "));
  CHECK(contains(ended.output, "3 open edges"));
  CHECK(contains(ended.output, "done: holes filled: 1, at ("));
  CHECK(contains(ended.output, "written to closed.stl: 12 triangles, 1 body, 24 mm2, 8 mm3; sound"));
  const Ended glb = run_program(
      {"repair", "open.stl", "--unit", "mm", "--largest-hole", "3 mm", "-o", "closed.glb"}, folder);
  CHECK(glb.exit_code == 0);
  CHECK(import_mesh(folder / "closed.glb", 0.0).mesh.volume() == doctest::Approx(8.0));
}

TEST_CASE("repair that cannot mend everything writes the mesh, prints what is left, and returns 1") {
  const auto folder = scratch_folder("repair_in_vain");
  write_stl(folder / "open.stl", box_with_hole());
  const Ended ended =
      run_program({"repair", "open.stl", "--unit", "mm", "--largest-hole", "1 mm", "-o", "same.stl"}, folder);
  CHECK(ended.exit_code == 1);
  check_contains(ended.output, {"not done:", "1 hole", "limit of 1 mm"});
  check_contains(ended.output, {"left:", "\"open.stl\"", "3 open edges"});
  CHECK(std::filesystem::exists(folder / "same.stl"));
  check_contains(run_program({"repair", "open.stl", "-o", "x.stl"}, folder).output,
                 {"does not state the unit"});
  check_contains(run_program({"repair", "open.stl", "--unit", "mm", "-o", "x.obj"}, folder).output,
                 {".stl", ".ply", "groups", ".glb"});
}

TEST_CASE("repair of a scene mends every mesh and writes a scene that names them") {
  const auto folder = scratch_folder("repair_scene");
  write_stl(folder / "open.stl", box_with_hole());
  write(folder / "index.csv", "wavelength (nm), n\n300, 1.5\n700, 1.5\n");
  write(folder / "scene.toml",
        "ambient = \"air\"\n"
        "[[part]]\nname = \"a\"\nmesh = \"open.stl\"  # broken\nunit = \"inch\"\nmedium = \"LSO\"\nsurface = "
        "\"polished\"\n"
        "[[part]]\nname = \"b\"\nmesh = \"open.stl\"\nunit = \"inch\"\nmedium = \"LSO\"\nsurface = "
        "\"polished\"\n"
        "translate = [\"90 mm\", \"0 mm\", \"0 mm\"]\n" +
            kSource);
  CHECK(run_program({"check", "scene.toml"}, folder).exit_code == 1);
  const Ended ended =
      run_program({"repair", "scene.toml", "--largest-hole", "100 mm", "-o", "mended"}, folder);
  CHECK(ended.exit_code == 0);
  CHECK(contains(ended.output, "names 1 mended mesh"));
  const std::string text = content(folder / "mended/scene.toml");
  CHECK(contains(text, "mesh = \"open_mended.stl\"  # broken\nunit = \"mm\"\n"));
  const Ended checked = run_program({"check", "mended/scene.toml"}, folder);
  CHECK(checked.exit_code == 0);
  CHECK(contains(checked.output, "131097"));  // 8 cubic inches in mm3
  check_contains(run_program({"repair", "scene.toml", "-o", "."}, folder).output,
                 {"output folder", "scene itself"});
}

TEST_CASE("repair of a scene mends the meshes of arrays, of single bodies, and of sweeps") {
  const auto folder = scratch_folder("repair_everywhere");
  const TriMesh open = box_with_hole();
  TriMesh beside = open;
  for (Vec3& v : beside.vertices) v.x() += 5.0;
  write_stl(folder / "open.stl", open);
  write_ply(folder / "open.ply", open);
  write_glb(folder / "two.glb", {{"left", &open, std::nullopt}, {"right", &beside, std::nullopt}},
            GltfAxes::as_they_are);
  const std::string end = "medium = \"LSO\"\nsurface = \"polished\"\n";
  write(
      folder / "scene.toml",
      "ambient = \"air\"\n"
      "[[part]]\nname = \"a\"\nmesh = \"two.glb\"\nbody = \"left\"\n" +
          end + "[[part]]\nname = \"b\"\nmesh = \"two.glb\"\nbody = 2\n" + end +
          "[[part]]\nname = \"c\"\nmesh = \"open.ply\"\nunit = \"mm\"\ntranslate = [\"20 mm\", \"0 mm\", \"0 "
          "mm\"]\n" +
          end +
          "[[part]]\nname = \"d\"\nmesh = \"open.stl\"\nunit = \"mm\"\ntranslate = [\"30 mm\", \"0 mm\", \"0 "
          "mm\"]\n" +
          end +
          "[[array]]\nname = \"block\"\ncount = [2, 1]\npitch = \"3 mm\"\ntranslate = [\"0 mm\", \"9 mm\", "
          "\"0 "
          "mm\"]\n[array.element]\nmesh = \"open.stl\"\nunit = \"mm\"\n" +
          end + "[[sweep]]\nkey = \"part.d.mesh\"\nvalues = [\"open.stl\", \"open.ply\"]\n" + kSource);
  CHECK(run_program({"check", "scene.toml"}, folder).exit_code == 1);
  const Ended ended = run_program({"repair", "scene.toml", "--largest-hole", "3 mm", "-o", "mended"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == 0);
  CHECK(contains(ended.output, "two.glb, body \"left\""));
  CHECK(contains(ended.output, "names 6 mended meshes"));
  const std::string text = content(folder / "mended/scene.toml");
  CAPTURE(text);
  CHECK(contains(text, "mesh = \"open_mended.ply\"\nunit = \"mm\""));
  CHECK(contains(text, "body = 2\n"));
  const Ended checked = run_program({"check", "mended/scene.toml", "--every-point"}, folder);
  CAPTURE(checked.output);
  CHECK(checked.exit_code == 0);
}

TEST_CASE("repair of a scene lists the meshes that it left, their places, and how to mend them") {
  const auto folder = scratch_folder("repair_left");
  write_stl(folder / "open.stl", box_with_hole());
  write(folder / "broken.stl", "solid nothing\nendsolid\n");
  const std::string end = "medium = \"LSO\"\nsurface = \"polished\"\n";
  write(folder / "scene.toml",
        "ambient = \"air\"\n[[part]]\nname = \"a\"\nmesh = \"open.stl\"\nunit = \"mm\"\n" + end +
            "[[part]]\nname = \"b\"\nmesh = \"broken.stl\"\nunit = \"mm\"\n" + end +
            "[[sweep]]\nkey = \"part.a.unit\"\nvalues = [\"mm\", \"cm\"]\n" + kSource);
  const Ended ended = run_program({"repair", "scene.toml", "--largest-hole", "3 mm", "-o", "mended"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == 1);
  check_contains(ended.output, {"left as it was: scene.toml:4:8: \"open.stl\"", "unit is swept"});
  CHECK(contains(ended.output, "left as it was: scene.toml:10:8: \"broken.stl\""));
  CHECK(contains(ended.output, "scintray repair open.stl -o MENDED.glb"));
  CHECK(contains(content(folder / "mended/scene.toml"), "mesh = \"../open.stl\""));
}

TEST_CASE("check reports several bodies in a mesh and gaps that look like mistakes") {
  const auto folder = scratch_folder("check_notes");
  write_stl(folder / "two.stl", joined(make_box({0, 0, 0}, {2, 2, 2}), make_box({5, 0, 0}, {7, 2, 2})));
  write(folder / "scene.toml",
        "ambient = \"air\"\n"
        "[[part]]\nname = \"two\"\nmesh = \"two.stl\"\nunit = \"mm\"\nmedium = \"LSO\"\nsurface = "
        "\"polished\"\n"
        "[[part]]\nname = \"plate\"\nmedium = \"glass\"\nsurface = \"polished\"\n"
        "box = { low = [\"0 mm\", \"0 mm\", \"2.001 mm\"], high = [\"7 mm\", \"2 mm\", \"3 mm\"] }\n" +
            kSource);
  const Ended ended = run_program({"check", "scene.toml", "--picture", "gaps.svg"}, folder);
  CHECK(ended.exit_code == 0);
  CHECK(contains(ended.output, "note: 2 separate surfaces"));
  check_contains(ended.output, {"warning:", "\"two\"", "\"plate\"", "0.001 mm apart at ("});
  CHECK(contains(content(folder / "gaps.svg"), "are 0.001 mm apart"));
}

TEST_CASE("check draws an imported scene whose media are still to be filled in") {
  const auto folder = scratch_folder("doctor_imported");
  write_stl(folder / "crystal.stl", make_box({0, 0, 0}, {3, 3, 20}));
  REQUIRE(run_program({"import", "crystal.stl", "--unit", "mm", "-o", "scene.toml"}, folder).exit_code == 0);
  const Ended ended = run_program({"check", "scene.toml", "--picture", "scene.svg"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == 1);
  check_contains(ended.output, {"picture: scene.svg", "parts: 1"});
  check_contains(ended.output, {"\"medium\""});
  CHECK(contains(content(folder / "scene.svg"), "no medium"));
}

TEST_CASE("Gaps of one pattern are one line: a builder's own are a note, others are ranked and numbered") {
  const auto folder = scratch_folder("check_patterns");
  const auto block = [](const std::string& name, const std::string& low, const std::string& high) {
    return "[[part]]\nname = \"" + name + "\"\nmedium = \"LSO\"\nsurface = \"polished\"\nbox = { low = [" +
           low + "], high = [" + high + "] }\n";
  };
  write(folder / "scene.toml",
        "ambient = \"air\"\n"
        "[[array]]\nname = \"crystal\"\ncount = [4, 4]\ngap = \"0.1 mm\"\n"
        "[array.element]\nbox = [\"3 mm\", \"3 mm\", \"20 mm\"]\nmedium = \"LSO\"\nsurface = \"polished\"\n"
        "[array.septa]\nreflector = \"ESR\"\nthickness = \"0.09 mm\"\n" +
            block("pin1", R"("0 mm", "40 mm", "0 mm")", R"("2 mm", "42 mm", "9 mm")") +
            block("pin2", R"("2.004 mm", "40 mm", "0 mm")", R"("4.004 mm", "42 mm", "9 mm")") +
            block("pin3", R"("4.008 mm", "40 mm", "0 mm")", R"("6.008 mm", "42 mm", "9 mm")") +
            block("lid", R"("0 mm", "40 mm", "9.002 mm")", R"("2 mm", "42 mm", "18 mm")") +
            "[source]\ntype = \"photons\"\nregion = { part = \"pin1\" }\nwavelength = \"420 nm\"\nphotons = "
            "10\n");
  const Ended ended = run_program({"check", "scene.toml", "--picture", "gaps.svg"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == 0);
  check_contains(ended.output, {"note:", "gaps of 0.005 mm", "\"crystal[*]\"", "left by their builder"});
  check_contains(ended.output, {"warning 1: 2 gaps of 0.004 mm", "\"pin*\"", "36 mm2 in all"});
  check_contains(ended.output,
                 {"contact_tolerance = \"0.0042 mm\"", "[[gap]] with between = [\"pin*\", \"pin*\"]"});
  check_contains(ended.output, {"warning 2: parts", "\"lid\"", "0.002 mm apart"});  // 4 mm2
  CHECK_FALSE(contains(ended.output, "warning 3"));
  CHECK_FALSE(contains(ended.output, "crystal[0"));
  const std::string picture = content(folder / "gaps.svg");
  check_contains(picture, "2 gaps of 0.004 mm");
  CHECK_FALSE(contains(picture, "left by their builder"));
  // Accepted as the hint says: counted, and no warning.
  write(folder / "accepted.toml", content(folder / "scene.toml") +
                                      "[[gap]]\nbetween = [\"pin*\", \"pin*\"]\n"
                                      "[[gap]]\nbetween = [\"pin2\", \"pin1\"]\n"
                                      "[[gap]]\nbetween = [\"lid\", \"pin2\"]\n");
  const Ended accepted = run_program({"check", "accepted.toml"}, folder);
  CAPTURE(accepted.output);
  check_contains(accepted.output,
                 {"note: 2 gaps of 0.004 mm between parts \"pin*\" and \"pin*\", accepted by [[gap]]"});
  check_contains(accepted.output, {"warning: parts", "\"lid\""});
  check_contains(accepted.output,
                 {"note: [[gap]] at accepted.toml", "no small gap between \"lid\" and \"pin2\""});
  CHECK_FALSE(contains(accepted.output, "between \"pin2\" and \"pin1\""));  // two entries may accept one gap
  CHECK_FALSE(contains(accepted.output, "warning 1"));
  write(folder / "mistyped.toml",
        content(folder / "scene.toml") + "[[gap]]\nbetween = [\"pim1\", \"pin2\"]\n");
  const std::string mistyped = run_program({"check", "mistyped.toml"}, folder).output;
  check_contains(mistyped, {"mistyped.toml:39", "pim1"});
  check_contains(mistyped, {"did you mean \"pin1\""});
  // Each gap of its own when asked.
  check_contains(run_program({"check", "scene.toml", "--all"}, folder).output, {"warning 3:"});
}

TEST_CASE("Parts of a medium without composition are named by patterns that vacuum takes") {
  const auto folder = scratch_folder("check_matter");
  const std::string scene =
      "ambient = \"air\"\n"
      "[[array]]\nname = \"crystal\"\ncount = [4, 4]\ngap = \"0.1 mm\"\n"
      "[array.element]\nbox = [\"3 mm\", \"3 mm\", \"9 mm\"]\nmedium = \"LYSO\"\nsurface = \"polished\"\n"
      "[array.septa]\nreflector = \"ESR\"\nthickness = \"0.065 mm\"\n"
      "[source]\ntype = \"gammas\"\nemission = \"gamma\"\nenergy = \"511 keV\"\nevents = 10\n"
      "position = [\"-9 mm\", \"0 mm\", \"4 mm\"]\ndirection = [1, 0, 0]\n";
  write(folder / "scene.toml", scene);
  const Ended ended = run_program({"check", "scene.toml"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == 1);
  check_contains(ended.output, {"12 parts \"crystal_septum_x[*]\"", "3 parts \"crystal_septum_y[*]\""});
  const std::string vacuum = "vacuum = [\"crystal_septum_x[*]\", \"crystal_septum_y[*]\"]";
  check_contains(ended.output, vacuum);
  CHECK_FALSE(contains(ended.output, "[0"));
  write(folder / "scene.toml", scene + vacuum + "\n");  // the hint as it is
  CHECK(run_program({"check", "scene.toml"}, folder).exit_code == 0);
}
