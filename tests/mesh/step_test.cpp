#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "import_message.hpp"
#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/import/import.hpp"
#include "support/shared.hpp"
#include "support/step_shapes.hpp"

// STEP files are written here through Open CASCADE's writer and read back through its reader: what is
// tested is what becomes of them in ScintRay.

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

namespace {

std::filesystem::path scratch(const std::string& name) {
  static const auto folder = scratch_folder("mesh_step");
  return folder / name;
}

MeshImport written_and_read(const std::vector<StepBody>& bodies, const ImportOptions& options = {},
                            const std::string& unit = "MM") {
  const auto path = scratch("shape.step");
  write_step(path, bodies, unit);
  return import_mesh(path, options);
}

StepBody crystal() {
  StepBody body{"crystal", StepSolid::box, {2.0, 3.0, 20.0}, {-1.0, -1.5, 0.0}, {}, {}, ""};
  body.face_names = {{1, "exit window"}, {2, "NONE"}};
  body.face_colours = {{1, "#0000ff"}, {3, "#ff8000"}, {4, "#ff8000"}};
  return body;
}

std::size_t selected(const TriMesh& mesh, const FaceSelector& selector) {
  const auto mask = select_triangles(mesh, selector);
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
}

FaceSelector by_group(const std::string& group) {
  FaceSelector selector;
  selector.group = group;
  return selector;
}

FaceSelector by_tag(const std::string& key, const std::string& value) {
  FaceSelector selector;
  selector.tags[key] = value;
  return selector;
}

/// Largest distance of a chord of the side of a cylinder about the z axis from its circle.
double sagitta_of_side(const TriMesh& mesh, double radius_mm) {
  double largest = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (std::abs(mesh.area_vector(t).normalized().z()) > 0.5) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const Vec3 middle = 0.5 * (mesh.vertices[from] + mesh.vertices[to]);
      largest = std::max(largest, radius_mm - middle.head<2>().norm());
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("STEP: a box has 12 triangles, its volume and no deviation to report") {
  const MeshImport read = written_and_read({crystal()});
  CHECK(read.mesh.triangles.size() == 12);
  CHECK(read.mesh.vertices.size() == 8);
  CHECK(read.mesh.volume() == doctest::Approx(120.0).epsilon(1e-12));
  CHECK(diagnose(read.mesh).sound());
  CHECK(read.unit_from_file == "millimetre");
  CHECK(read.notes.empty());
  CHECK(read.bodies == std::vector<std::string>{"crystal"});
}

TEST_CASE("STEP: a face is called after its name, else its colour, else its number, and keeps all as tags") {
  const TriMesh mesh = written_and_read({crystal()}).mesh;
  CHECK(mesh.groups.size() == 6);
  CHECK(selected(mesh, by_group("exit window")) == 2);
  CHECK(selected(mesh, by_group("#ff8000")) == 4);
  CHECK(selected(mesh, by_tag("color", "#ff8000")) == 4);
  CHECK(selected(mesh, by_tag("color", "#0000ff")) == 2);
  CHECK(selected(mesh, by_group("face2")) == 2);
  CHECK(selected(mesh, by_group("NONE")) == 0);
  CHECK(selected(mesh, by_group("face1")) == 2);  // its number also holds for a face with a name
  CHECK(selected(mesh, by_tag("face", "face3")) == 2);
  FaceSelector both = by_tag("color", "#ff8000");
  both.group = "face4";
  CHECK(selected(mesh, both) == 2);
}

TEST_CASE("STEP: a colour of the whole solid is the colour of its faces, not their name") {
  StepBody body = crystal();
  body.face_names.clear();
  body.face_colours = {{1, "#0000ff"}};
  body.colour = "#c0c0c0";
  const TriMesh mesh = written_and_read({body}).mesh;
  CHECK(selected(mesh, by_tag("color", "#c0c0c0")) == 10);
  CHECK(selected(mesh, by_group("#c0c0c0")) == 0);
  CHECK(selected(mesh, by_group("#0000ff")) == 2);
}

TEST_CASE("STEP: curved faces keep the requested tolerance, and the note has the one reached") {
  const StepBody rod{"rod", StepSolid::cylinder, {5.0, 0.0, 10.0}, {0.0, 0.0, 0.0}, {}, {}, ""};
  for (const double deviation : {0.1, 0.01, 0.001}) {
    CAPTURE(deviation);
    ImportOptions options;
    options.tessellation = {deviation, 20.0 * kDegree};
    const MeshImport read = written_and_read({rod}, options);
    CHECK(diagnose(read.mesh).sound());
    const double reached = sagitta_of_side(read.mesh, 5.0);
    CHECK(reached > 0.0);
    CHECK(reached < deviation);
    REQUIRE(read.notes.size() == 1);
    check_contains(read.notes[0], {"curved CAD faces", "tessellated within"});
    check_contains(read.notes[0], "20 deg");
    double noted = 0.0;
    std::istringstream(read.notes[0].substr(read.notes[0].find("within ") + 7)) >> noted;
    CHECK(noted == doctest::Approx(reached).epsilon(0.01));
  }
}

TEST_CASE("STEP: a free-form strip keeps the requested deviation, a finer one too") {
  const auto file = shared_file("findings/inputs/cad/featuretype.step");
  if (!file) return;
  for (const double deviation : {0.01, 0.002}) {
    CAPTURE(deviation);
    ImportOptions options;
    options.tessellation.deviation_mm = deviation;
    const MeshImport read = import_mesh(*file, options);
    REQUIRE(read.notes.size() == 1);
    double noted = 0.0;
    std::istringstream(read.notes[0].substr(read.notes[0].find("within ") + 7)) >> noted;
    CHECK(noted > 0.0);
    CHECK(noted <= deviation);
    CHECK(read.mesh.volume() == doctest::Approx(190448.0).epsilon(1e-4));
    if (deviation == 0.01) CHECK(diagnose(read.mesh).closed());
  }
}

TEST_CASE("STEP: a free-form strip divided by a fine angle is closed") {
  const auto file = shared_file("findings/inputs/cad/featuretype.step");
  if (!file) return;
  ImportOptions options;
  options.tessellation.deviation_mm = 0.01;
  options.tessellation.angle_rad = 1.0 * kDegree;
  const MeshImport read = import_mesh(*file, options);
  const MeshDiagnosis diagnosis = diagnose(read.mesh);
  CHECK(diagnosis.closed());
  CHECK(diagnosis.degenerate_triangles.count == 0);
  CHECK(diagnosis.volume_mm3 == doctest::Approx(190448.0).epsilon(1e-4));
}

TEST_CASE("STEP: the angle bounds a small circle that the deviation would leave coarse") {
  const StepBody fibre{"fibre", StepSolid::cylinder, {0.01, 0.0, 1.0}, {0.0, 0.0, 0.0}, {}, {}, ""};
  const MeshImport read = written_and_read({fibre});
  // 5 deg a segment: the reported deviation is r (1 - cos 2.5 deg) or less.
  CHECK(sagitta_of_side(read.mesh, 0.01) <= 0.01 * (1.0 - std::cos(2.5 * kDegree)) * (1.0 + 1e-9));
  CHECK(read.mesh.volume() == doctest::Approx(kPi * 1e-4).epsilon(0.002));
}

TEST_CASE("STEP: meshes of curved and drilled solids are closed, with poles and seams welded") {
  for (const StepSolid solid : {StepSolid::cylinder, StepSolid::sphere, StepSolid::drilled_box}) {
    const MeshImport read = written_and_read({{"part", solid, {7.0, 6.0, 5.0}, {1.0, 2.0, 3.0}, {}, {}, ""}});
    const MeshDiagnosis diagnosis = diagnose(read.mesh);
    CHECK(diagnosis.sound());
    CHECK(diagnosis.bodies == 1);
    const double volume = solid == StepSolid::cylinder ? kPi * 49.0 * 5.0
                          : solid == StepSolid::sphere ? 4.0 / 3.0 * kPi * 343.0
                                                       : 7.0 * 6.0 * 5.0 - kPi * 2.25 * 5.0;
    CHECK(diagnosis.volume_mm3 == doctest::Approx(volume).epsilon(0.005));
  }
}

TEST_CASE("STEP: round faces carry their surface, in the unit of the import, also of one body of several") {
  const StepBody rod{"rod", StepSolid::cylinder, {2.0, 0.0, 5.0}, {10.0, 0.0, 0.0}, {}, {}, ""};
  const StepBody ball{"ball", StepSolid::sphere, {3.0, 0.0, 0.0}, {-10.0, 0.0, 1.0}, {}, {}, ""};
  const StepBody block{"block", StepSolid::drilled_box, {7.0, 6.0, 5.0}, {0.0, 20.0, 0.0}, {}, {}, ""};
  for (const std::string chosen : {"", "rod", "ball", "block"}) {
    CAPTURE(chosen);
    ImportOptions options;
    options.body = chosen;
    options.scale = 2.0;
    options.tessellation.deviation_mm = 0.1;  // the ball has a radius of 152 mm
    const TriMesh mesh = written_and_read({rod, ball, block}, options, "INCH").mesh;
    CHECK(mesh.supports.size() == (chosen.empty() ? 3 : 1));
    std::size_t round = 0;
    double largest_tilt = 0.0,
           largest_distance_mm = 0.0;  // of flat faces from an axis, of vertices from their surface
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t support = mesh.support_of(t);
      const Vec3 normal = mesh.area_vector(t).normalized();
      if (support == kNoSupport) {
        largest_tilt = std::max(largest_tilt, std::abs(normal.cwiseAbs().maxCoeff() - 1.0));
        continue;
      }
      ++round;
      for (const std::uint32_t vertex : mesh.triangles[t])
        largest_distance_mm =
            std::max(largest_distance_mm, std::abs(mesh.supports[support].distance(mesh.vertices[vertex])));
    }
    CHECK(round > 20);
    CHECK(largest_tilt < 1e-6);
    CHECK(largest_distance_mm < 1e-9 * 50.8);
  }
  CHECK(written_and_read({{"box", StepSolid::box, {1.0, 2.0, 3.0}, {0.0, 0.0, 0.0}, {}, {}, ""}})
            .mesh.support.empty());
}

TEST_CASE("STEP: the unit is the file's, inches too, and another one is refused") {
  const StepBody body{"crystal", StepSolid::box, {1.0, 2.0, 3.0}, {0.0, 0.0, 0.0}, {}, {}, ""};
  const MeshImport read = written_and_read({body}, {}, "INCH");
  CHECK(read.mesh.volume() == doctest::Approx(6.0 * 25.4 * 25.4 * 25.4).epsilon(1e-9));
  CHECK(read.unit_from_file == "INCH");
  ImportOptions same, other, scaled;
  same.mm_per_unit = 25.4;
  other.mm_per_unit = 1.0;
  scaled.scale = 0.5;
  CHECK(import_mesh(scratch("shape.step"), same).mesh.volume() == doctest::Approx(read.mesh.volume()));
  CHECK(import_mesh(scratch("shape.step"), scaled).mesh.volume() ==
        doctest::Approx(read.mesh.volume() / 8.0));
  check_contains(message(scratch("shape.step"), other), "unit INCH (25.4 mm)");
  write_step(scratch("metres.step"), {body}, "M");
  CHECK(import_mesh(scratch("metres.step"), 1000.0).mesh.volume() == doctest::Approx(6e9).epsilon(1e-9));
}

TEST_CASE("STEP: one solid of several is chosen by name or number, and no choice is noted") {
  StepBody a = crystal(), b = crystal(), c = crystal();
  b.at[0] = 5.0;
  c.at[0] = 10.0;
  c.name = "light guide";
  const MeshImport all = written_and_read({a, b, c});
  CHECK(all.bodies == std::vector<std::string>{"crystal", "crystal 2", "light guide"});
  CHECK(all.mesh.volume() == doctest::Approx(360.0));
  REQUIRE(all.notes.size() == 1);
  check_contains(all.notes[0], {"3 bodies", "one part", "\"crystal\", \"crystal 2\""});
  ImportOptions options;
  for (const char* chosen : {"crystal 2", "2"}) {
    options.body = chosen;
    const MeshImport one = import_mesh(scratch("shape.step"), options);
    CHECK(one.mesh.volume() == doctest::Approx(120.0));
    CHECK(diagnose(one.mesh).bounds.min().x() == doctest::Approx(5.0));
    CHECK(one.mesh.groups.size() == 6);
    CHECK(one.notes.empty());
  }
  options.body = "cristal";
  check_contains(message(scratch("shape.step"), options), "did you mean \"crystal\"?");
  options.body = "4";
  check_contains(message(scratch("shape.step"), options), {"no body", "\"4\""});
}

TEST_CASE("STEP: what is no shape is refused with the file's name and a hint") {
  const auto write = [](const std::string& name, const std::string& text) {
    std::ofstream(scratch(name), std::ios::binary) << text;
    return scratch(name);
  };
  check_contains(message(write("empty.step", "")), {"mesh file", "empty"});
  check_contains(message(write("text.stp", "hello")), {"cannot read", "STEP"});
  check_contains(
      message(write("none.step",
                    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),"
                    "'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\n"
                    "END-ISO-10303-21;\n")),
      "none.step");
  ImportOptions options;
  options.tessellation.deviation_mm = 1e-9;
  write_step(scratch("fine.step"), {crystal()});
  check_contains(message(scratch("fine.step"), options), "finer than a millionth");
}

TEST_CASE("STEP: references that form a loop or lead nowhere are refused before anything follows them") {
  write_step(scratch("sound.step"), {crystal()});
  std::ifstream file(scratch("sound.step"), std::ios::binary);
  const std::string sound{std::istreambuf_iterator<char>(file), {}};
  const auto changed = [&sound](const std::string& entity, const std::string& from, const std::string& to) {
    std::string text = sound;
    const std::size_t at = text.find(from, text.find(entity));
    text.replace(at, from.size(), to);
    std::ofstream(scratch("changed.step"), std::ios::binary) << text;
    return scratch("changed.step");
  };
  // The first reference of a face is to its bounds.
  const std::size_t face = sound.find("ADVANCED_FACE");
  const std::size_t reference = sound.find('#', face);
  const std::string target =
      sound.substr(reference, sound.find_first_not_of("0123456789", reference + 1) - reference);
  const std::size_t line = sound.rfind('\n', face) + 1;
  const std::string own = sound.substr(line, sound.find(' ', line) - line);
  check_contains(message(changed("ADVANCED_FACE", target, own)),
                 own + " refers to " + own + ", which is made of it");
  check_contains(message(changed("ADVANCED_FACE", target, "#999999")), {"#999999", "not in the file"});
}

TEST_CASE("STEP: what makes Open CASCADE crash is an error of the file") {
  // An edge that begins at a direction instead of a vertex.
  write_step(scratch("sound.step"), {crystal()});
  std::ifstream file(scratch("sound.step"), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t direction = text.rfind("\n#", text.find("= DIRECTION"));
  const std::string number = text.substr(direction + 1, text.find(' ', direction) - direction - 1);
  const std::size_t edge = text.find("EDGE_CURVE"), vertex = text.find('#', edge);
  text.replace(vertex, text.find(',', vertex) - vertex, number);
  std::ofstream(scratch("crash.step"), std::ios::binary) << text;
  check_contains(message(scratch("crash.step")), "crash.step");
  // And this program goes on.
  CHECK(import_mesh(scratch("sound.step"), 0.0).mesh.triangles.size() == 12);
}
