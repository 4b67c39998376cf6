// COLLADA files.
#include "mesh/box_files.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

namespace {

/// The box, moved by 10 along x, with this content of <asset>.
std::string collada_text(const std::string& asset) {
  std::string floats, faces;
  for (int c = 0; c < 8; ++c) {
    floats += std::to_string(c & 1) + " " + std::to_string((c >> 1 & 1) * 2) + " " +
              std::to_string((c >> 2 & 1) * 3) + " ";
  }
  for (const auto& q : kQuads) {
    for (const int k : {0, 1, 2, 0, 2, 3}) faces += std::to_string(q[k]) + " ";
  }
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         asset + R"(</asset><library_geometries><geometry id="g" name="crystal"><mesh>
<source id="p"><float_array id="a" count="24">)" +
         floats + R"(</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         faces + R"(</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
<translate>10 0 0</translate><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

}  // namespace

TEST_CASE("COLLADA keeps its axes and applies node transforms; it is in metres unless it states a unit") {
  const std::filesystem::path path = mesh_file("box.dae", collada_text("<up_axis>Z_UP</up_axis>"));
  const MeshImport read = import_mesh(path, 1.0);
  check_box(read, 1.0);
  const auto bounds = diagnose(read.mesh).bounds;
  CHECK((bounds.min() - Vec3(10, 0, 0)).norm() < 1e-5);
  CHECK((bounds.max() - Vec3(11, 2, 3)).norm() < 1e-5);
  REQUIRE_FALSE(read.notes.empty());
  CHECK(read.notes[0] == "the unit given, 1 mm, replaces what the format prescribes, meter (1000 mm)");
  check_box(import_mesh(path, 0.0), 1000.0);
}

TEST_CASE("COLLADA: counts and references that do not fit are refused") {
  const std::string text = collada_text("");
  const auto changed = [&text](const std::string& from, const std::string& to) {
    std::string copy = text;
    copy.replace(copy.find(from), from.size(), to);
    return mesh_file("changed.dae", copy);
  };
  check_refused(changed("count=\"8\" stride", "count=\"9\" stride"), 1.0, {"accessor", "27 numbers", "24"});
  check_refused(changed("<p>0 4 6", "<p>0 4 8"), 1.0, {"vertex 8", "not exist"});
  check_refused(changed("url=\"#g\"", "url=\"#h\""), 1.0, {"\"#h\"", "not in the file"});
  check_refused(changed("<translate>10 0 0", "<translate>10 0"), 1.0,
                {"<translate>", "2 numbers", "expected 3"});
  check_refused(changed("<instance_geometry url=\"#g\"/>", "<instance_node url=\"#n\"/>"), 1.0,
                "inside themselves");
}

TEST_CASE("COLLADA: polylists, nested nodes in order, and bound materials") {
  std::string text = collada_text("");
  const std::size_t start = text.find("<triangles"), end = text.find("</triangles>") + 12;
  std::string sizes, corners;
  for (const auto& quad : kQuads) {
    sizes += "4 ";
    for (const int corner : quad) corners += std::to_string(corner) + " 7 ";
  }
  text.replace(
      start, end - start,
      "<polylist count=\"6\" material=\"symbol\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
      "<input semantic=\"NORMAL\" source=\"#none\" offset=\"1\"/><vcount>" +
          sizes + "</vcount><p>" + corners + "</p></polylist>");
  const std::string instance = "<instance_geometry url=\"#g\"/>";
  text.replace(
      text.find(instance), instance.size(),
      "<rotate>0 0 1 90</rotate><node name=\"inner\"><scale>2 1 1</scale><instance_geometry url=\"#g\">"
      "<bind_material><technique_common><instance_material symbol=\"symbol\" target=\"#m\"/>"
      "</technique_common></bind_material></instance_geometry></node>");
  text.insert(text.find("<library_geometries>"),
              "<library_materials><material id=\"m\" name=\"polished\"/></library_materials>");
  const MeshImport read = import_mesh(mesh_file("nested.dae", text), 1.0);
  CHECK(read.mesh.volume() == doctest::Approx(12.0));
  CHECK(diagnose(read.mesh).sound());
  CHECK(read.mesh.groups == std::vector<std::string>{"crystal:polished"});
  CHECK(read.bodies == std::vector<std::string>{"inner"});
  // Moved by 10 along x, turned about z by 90 deg, scaled along its own x: (x, y, z) -> (10 - y, 2 x, z).
  const auto bounds = diagnose(read.mesh).bounds;
  CHECK((bounds.min() - Vec3(8, 0, 0)).norm() < 1e-9);
  CHECK((bounds.max() - Vec3(10, 2, 3)).norm() < 1e-9);
}

TEST_CASE("COLLADA's own unit is used, and another one given is an error") {
  const std::string inch = R"(<unit name="inch" meter="0.0254"/>)";
  const MeshImport read = import_mesh(mesh_file("inch.dae", collada_text(inch)), 0.0);
  check_box(read, 25.4);
  CHECK(read.unit_from_file == "inch");
  CHECK(diagnose(read.mesh).bounds.min().x() == doctest::Approx(254.0));
  check_box(import_mesh(mesh_file("inch.dae", collada_text(inch)), 25.4), 25.4);
  check_refused(mesh_file("inch.dae", collada_text(inch)), 1.0, "unit inch (25.4 mm)");
  check_refused(mesh_file("bad.dae", collada_text(R"(<unit name="inch" meter="none"/>)")), 0.0,
                {"unit", "\"none\" metres"});
  check_refused(mesh_file("bad.dae", collada_text(R"(<unit meter="-1"/>)")), 0.0, "above 0");
}

TEST_CASE(
    "COLLADA: nodes placed by <lookat>, numbers with a plus, blanks in the unit, and materials elsewhere are "
    "read") {
  std::string text = collada_text("<unit meter=\" +0.001 \" name=\"millimeter\"/>");
  const auto change = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  // From (5, 0, 0) towards x: the node's -z is x, its y is z, so its x is -y.
  change("<translate>10 0 0</translate>", "<lookat>+5 0 0  6 0 0  0 0 1</lookat>");
  change("<instance_geometry url=\"#g\"/>",
         "<instance_geometry url=\"#g\"><bind_material><technique_common><instance_material symbol=\"m\" "
         "target=\"library.dae#paint\"/></technique_common></bind_material></instance_geometry>");
  change("<triangles count", "<triangles material=\"m\" count");
  const MeshImport read = import_mesh(mesh_file("lookat.dae", text), 0.0);
  check_box(read, 1.0);
  const auto bounds = diagnose(read.mesh).bounds;
  CHECK((bounds.min() - Vec3(2, -1, 0)).norm() < 1e-9);
  CHECK((bounds.max() - Vec3(5, 0, 2)).norm() < 1e-9);
  CHECK(read.mesh.groups == std::vector<std::string>{"crystal:paint"});
}

TEST_CASE("COLLADA: <skew> moves points along its first axis, in proportion to the way along the second") {
  const auto skewed = [](const std::string& numbers) {
    std::string text = collada_text("<unit meter=\"0.001\" name=\"millimeter\"/>");
    const std::string from = "<translate>10 0 0</translate>";
    text.replace(text.find(from), from.size(), "<skew>" + numbers + "</skew>");
    return mesh_file("skew.dae", text);
  };
  // The box of 1 x 2 x 3 mm. The second to fifth are those of the COLLADA Conformance Test Suite
  // (node_skew_cube.dae to node_skew_cube3.dae); its picture of the first of them shows which axis is which.
  const double s = std::sqrt(0.5);
  struct Skew {
    const char* numbers;
    Vec3 low, high;
    double volume;
  };
  for (const Skew& skew : {Skew{"45 1 0 0 0 1 0", {0, 0, 0}, {3, 2, 3}, 6},
                           {"45 1 1 0 0 0 1", {0, 0, 0}, {1 + 3 * s, 2 + 3 * s, 3}, 6},
                           {"-45 1 1 0 0 0 1", {-3 * s, -3 * s, 0}, {1, 2, 3}, 6},
                           {"45 0 1 1 0 0 1", {0, 0, 0}, {1, 2 + 3 * s, 3 + 3 * s}, 6 * (1 + s)},
                           {"45 1 1 0 1 0 0", {0, 0, 0}, {1 + s, 2 + s, 3}, 6 * (1 + s)},
                           {"0 0 2 0 3 0 0", {0, 0, 0}, {1, 2, 3}, 6}}) {
    CAPTURE(skew.numbers);
    const MeshDiagnosis diagnosis = diagnose(import_mesh(skewed(skew.numbers), 0.0).mesh);
    CHECK(diagnosis.sound());
    CHECK(diagnosis.volume_mm3 == doctest::Approx(skew.volume));
    CHECK((diagnosis.bounds.min() - skew.low).norm() < 1e-6);
    CHECK((diagnosis.bounds.max() - skew.high).norm() < 1e-6);
  }
  for (const char* numbers :
       {"90 0 1 0 1 0 0", "-90 0 1 0 1 0 0", "120 0 1 0 1 0 0", "45 0 0 0 1 0 0", "-45 1 0 0 1 0 0"})
    check_refused(skewed(numbers), 0.0, "<skew>");
}
