#include "scintray/mesh/import.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/polygon.hpp"
#include "support/shared.hpp"
#include "support/zipped.hpp"

using namespace scintray;

namespace {

std::filesystem::path mesh_file(const std::string& name, const std::string& text) {
  static const auto folder = test::scratch_folder("mesh_import");
  const auto path = folder / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// Corners of the box 0..1 x 0..2 x 0..3, one a line.
std::string corner_lines(const std::string& before) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += before + std::to_string(corner & 1) + " " + std::to_string((corner >> 1 & 1) * 2) + " " +
            std::to_string((corner >> 2 & 1) * 3) + "\n";
  }
  return text;
}

/// Its sides as quadrilaterals, outwards.
constexpr int kQuads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

std::string quad_lines(const std::string& before, int first_index) {
  std::string text;
  for (const auto& quad : kQuads) {
    text += before;
    for (const int corner : quad) text += std::to_string(corner + first_index) + " ";
    text += "\n";
  }
  return text;
}

void check_box(const MeshImport& read, double mm_per_unit) {
  CHECK(read.mesh.vertices.size() == 8);
  CHECK(read.mesh.triangles.size() == 12);
  CHECK(read.mesh.volume() == doctest::Approx(6.0 * std::pow(mm_per_unit, 3)).epsilon(1e-6));
  CHECK(read.mesh.group.size() == 12);
  CHECK(diagnose(read.mesh).sound());
}

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

/// A 3MF archive of the box with these attributes of <model> and this <build>.
std::string three_mf(const std::string& attributes, const std::string& build = "<item objectid=\"1\"/>") {
  std::string vertices, triangles;
  for (int c = 0; c < 8; ++c)
    vertices += "<vertex x=\"" + std::to_string(c & 1) + "\" y=\"" + std::to_string((c >> 1 & 1) * 2) +
                "\" z=\"" + std::to_string((c >> 2 & 1) * 3) + "\"/>";
  for (const auto& q : kQuads)
    for (const int k : {1, 2})
      triangles += "<triangle v1=\"" + std::to_string(q[0]) + "\" v2=\"" + std::to_string(q[k]) + "\" v3=\"" +
                   std::to_string(q[k + 1]) + "\"/>";
  const std::string model = "<?xml version=\"1.0\"?><model" + attributes +
                            " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
                            "<object id=\"1\" type=\"model\" name=\"crystal\"><mesh><vertices>" +
                            vertices + "</vertices><triangles>" + triangles +
                            "</triangles></mesh></object></resources><build>" + build + "</build></model>";
  const std::string relationships =
      "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
      "Target=\"/3D/3dmodel.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  return test::zipped({{"_rels/.rels", relationships}, {"3D/3dmodel.model", model}}, true);
}

void check_refused(const std::filesystem::path& path, double mm_per_unit, const std::string& words) {
  CHECK_THROWS_WITH_AS(import_mesh(path, mm_per_unit), doctest::Contains(words.c_str()), InputError);
}

std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text.push_back(i + k > bytes.size() ? '=' : digits[block >> (18 - 6 * k) & 63U]);
    }
  }
  return text;
}

/// 8 corners as floats, then the sides' triangles as 16-bit indices: 96 + 72 bytes.
std::string gltf_buffer() {
  std::string bytes;
  for (int corner = 0; corner < 8; ++corner) {
    const float xyz[3] = {static_cast<float>(corner & 1), static_cast<float>((corner >> 1 & 1) * 2),
                          static_cast<float>((corner >> 2 & 1) * 3)};
    bytes.append(reinterpret_cast<const char*>(xyz), sizeof xyz);
  }
  for (const auto& quad : kQuads) {
    for (const int k : {0, 1, 2, 0, 2, 3}) {
      bytes.push_back(static_cast<char>(quad[k]));
      bytes.push_back('\0');
    }
  }
  return bytes;
}

/// The box with its last side in the material "polished", the others in "ground".
std::string gltf_text(const std::string& buffer, const std::string& node) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + node + R"(],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0},
                             {"attributes":{"POSITION":0},"indices":2,"material":1}]}],
    "materials":[{"name":"ground"},{"name":"polished"}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,2,3]},
                 {"bufferView":1,"componentType":5123,"count":30,"type":"SCALAR"},
                 {"bufferView":1,"byteOffset":60,"componentType":5123,"count":6,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],
    "buffers":[{"byteLength":168)" +
         buffer + "}]}";
}

std::string embedded() {
  return R"(,"uri":"data:application/octet-stream;base64,)" + base64(gltf_buffer()) + "\"";
}

std::string little_endian(std::uint32_t value) {
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xFFU);
  return bytes;
}

std::string glb(std::string json, const std::string& binary) {
  while (json.size() % 4 != 0) json.push_back(' ');
  return "glTF" + little_endian(2) +
         little_endian(static_cast<std::uint32_t>(28 + json.size() + binary.size())) +
         little_endian(static_cast<std::uint32_t>(json.size())) + "JSON" + json +
         little_endian(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
}

}  // namespace

TEST_CASE("OBJ, OFF, PLY and ASCII STL give the same box in mm") {
  const MeshImport obj = import_mesh(mesh_file("box.obj", corner_lines("v ") + quad_lines("f ", 1)), 1.0);
  check_box(obj, 1.0);
  CHECK(obj.mesh.groups == std::vector<std::string>{"default"});
  check_box(import_mesh(mesh_file("box.off", "OFF\n8 6 12\n" + corner_lines("") + quad_lines("4 ", 0)), 10.0),
            10.0);
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  check_box(import_mesh(mesh_file("BOX.PLY", header + corner_lines("") + quad_lines("4 ", 0)), 0.001), 0.001);

  std::string stl = "solid crystal\n";
  for (const auto& quad : kQuads) {
    for (const auto& corners : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
      stl += "facet normal 0 0 0\nouter loop\n";
      for (const int k : corners) {
        const int v = quad[k];
        stl += "vertex " + std::to_string(v & 1) + " " + std::to_string((v >> 1 & 1) * 2) + " " +
               std::to_string((v >> 2 & 1) * 3) + "\n";
      }
      stl += "endloop\nendfacet\n";
    }
  }
  check_box(import_mesh(mesh_file("box.stl", stl + "endsolid crystal\n"), 1.0), 1.0);
}

TEST_CASE("Binary PLY of either byte order, data that look like white space included") {
  for (const bool little : {true, false}) {
    const auto put = [little](std::string& bytes, std::uint64_t value, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i) {
        bytes.push_back(static_cast<char>(value >> (8 * (little ? i : size - 1 - i)) & 0xFFU));
      }
    };
    std::string text =
        std::string("ply\r\nformat ") + (little ? "binary_little_endian" : "binary_big_endian") +
        " 1.0\r\ncomment of no matter\r\nelement face 6\r\nproperty uchar red\r\n"
        "property list uint short vertex_index\r\nelement vertex 8\r\nproperty double x\r\n"
        "property float y\r\nproperty int z\r\nelement edge 1\r\nproperty char a\r\nend_header\r\n";
    for (const auto& quad : kQuads) {
      put(text, 0x0A, 1);
      put(text, 4, 4);
      for (const int corner : quad) put(text, static_cast<std::uint64_t>(corner), 2);
    }
    for (int corner = 0; corner < 8; ++corner) {
      put(text, std::bit_cast<std::uint64_t>(0.1 + (corner & 1)), 8);
      put(text, std::bit_cast<std::uint32_t>((corner >> 1 & 1) * 2.0F), 4);
      put(text, static_cast<std::uint32_t>((corner >> 2 & 1) * 3 - 3), 4);  // -3 and 0
    }
    put(text, 0x20, 1);
    const MeshImport read = import_mesh(mesh_file("binary.ply", text), 1.0);
    check_box(read, 1.0);
    const auto bounds = diagnose(read.mesh).bounds;
    CHECK(bounds.min() == Vec3(0.1, 0.0, -3.0));  // exactly: double precision is kept
    CHECK(bounds.max() == Vec3(1.1, 2.0, 0.0));
    CHECK(read.notes == std::vector<std::string>{"1 elements \"edge\" left out"});
  }
}

TEST_CASE("COLLADA keeps its axes and applies node transforms; it is in metres unless it says otherwise") {
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
  check_refused(changed("count=\"8\" stride", "count=\"9\" stride"), 1.0,
                "an accessor reaches for 27 numbers, but there are 24");
  check_refused(changed("<p>0 4 6", "<p>0 4 8"), 1.0, "refers to vertex 8, which does not exist");
  check_refused(changed("url=\"#g\"", "url=\"#h\""), 1.0, "\"#h\", which is not in the file");
  check_refused(changed("<translate>10 0 0", "<translate>10 0"), 1.0,
                "<translate> has 2 numbers; expected 3");
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
  check_refused(mesh_file("inch.dae", collada_text(inch)), 1.0, "says that it is in inch (25.4 mm)");
  check_refused(mesh_file("bad.dae", collada_text(R"(<unit name="inch" meter="none"/>)")), 0.0,
                "gives its unit as \"none\" metres");
  check_refused(mesh_file("bad.dae", collada_text(R"(<unit meter="-1"/>)")), 0.0, "above 0");
}

TEST_CASE("3MF is in the unit of its model, millimetres when it names none") {
  const std::pair<const char*, double> units[] = {{"", 1.0},
                                                  {" unit=\"micron\"", 1e-3},
                                                  {" unit=\"millimeter\"", 1.0},
                                                  {" unit=\"centimeter\"", 10.0},
                                                  {" unit=\"inch\"", 25.4},
                                                  {" unit=\"foot\"", 304.8},
                                                  {" unit=\"meter\"", 1000.0}};
  for (const auto& [unit, mm] : units) {
    CAPTURE(unit);
    check_box(import_mesh(mesh_file("box.3mf", three_mf(unit)), 0.0), mm);
  }
  check_refused(mesh_file("inch.3mf", three_mf(" unit=\"inch\"")), 1.0, "says that it is in inch (25.4 mm)");
  check_refused(mesh_file("bad.3mf", three_mf(" unit=\"ell\"")), 0.0, "is in \"ell\"");
}

TEST_CASE("3MF: components are placed, base materials are groups, and what leads nowhere is refused") {
  const auto model = [](const std::string& objects, const std::string& build) {
    return mesh_file(
        "made.3mf",
        test::zipped({{"_rels/.rels", ""},
                      {"3D/3dmodel.model", "<model><resources>" + objects + "</resources><build>" + build +
                                               "</build></model>"}}));
  };
  const std::string tetrahedron =
      "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"6\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" "
      "z=\"0\"/>"
      "<vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/>"
      "<triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/>"
      "<triangle v1=\"2\" v2=\"0\" v3=\"3\" pid=\"9\" p1=\"1\"/></triangles>";
  const std::string objects =
      "<basematerials id=\"9\"><base name=\"ground\"/><base name=\"polished\"/></basematerials>"
      "<object id=\"1\" name=\"tip\" pid=\"9\" pindex=\"0\"><mesh>" +
      tetrahedron +
      "</mesh></object><object id=\"2\" name=\"pair\"><components><component objectid=\"1\"/>"
      "<component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 -10 0 0\"/></components></object>";
  const MeshImport pair = import_mesh(model(objects, "<item objectid=\"2\"/>"), 0.0);
  CHECK(pair.mesh.volume() == doctest::Approx(2.0));
  CHECK(diagnose(pair.mesh).sound());
  CHECK(diagnose(pair.mesh).bounds.min().x() == doctest::Approx(-16.0));
  CHECK(pair.bodies == std::vector<std::string>{"pair"});
  CHECK(pair.mesh.groups == std::vector<std::string>{"tip:ground", "tip:polished"});
  check_refused(model(objects, "<item objectid=\"3\"/>"), 0.0,
                "refers to object \"3\", which does not exist");
  check_refused(model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>",
                      "<item objectid=\"1\"/>"),
                0.0, "made of themselves");
  std::string doubling = "<object id=\"0\"><mesh>" + tetrahedron + "</mesh></object>";
  for (int level = 1; level <= 60; ++level)
    doubling += "<object id=\"" + std::to_string(level) + "\"><components><component objectid=\"" +
                std::to_string(level - 1) + "\"/><component objectid=\"" + std::to_string(level - 1) +
                "\"/></components></object>";
  check_refused(model(doubling, "<item objectid=\"60\"/>"), 0.0, "multiply to more than");
  check_refused(
      model("<object id=\"1\"><mesh><vertices><vertex x=\"a\" y=\"0\" z=\"0\"/></vertices></mesh></object>",
            ""),
      0.0, "x=\"a\", which is not a number");
}

TEST_CASE("3MF objects are bodies, with the transforms of their items") {
  const std::filesystem::path path =
      mesh_file("two.3mf", three_mf(" unit=\"inch\"",
                                    "<item objectid=\"1\"/>"
                                    "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/>"));
  const MeshImport all = import_mesh(path, 0.0);
  CHECK(all.mesh.volume() == doctest::Approx(12.0 * std::pow(25.4, 3)).epsilon(1e-5));
  REQUIRE(all.bodies.size() == 2);
  ImportOptions options;
  options.body = "2";
  const MeshImport second = import_mesh(path, options);
  check_box(second, 25.4);
  CHECK(diagnose(second.mesh).bounds.min().x() == doctest::Approx(254.0));
}

TEST_CASE("An OBJ object is a body, whatever its materials") {
  const std::string faces = quad_lines("f ", 1);
  const std::size_t last = faces.rfind("f ");
  const std::string text = corner_lines("v ") + "o a\nusemtl x\n" + faces + "o b\nusemtl x\n" +
                           faces.substr(0, last) + "usemtl y\n" + faces.substr(last);
  const std::filesystem::path path = mesh_file("bodies.obj", text);
  CHECK(import_mesh(path, 1.0).bodies == std::vector<std::string>{"a", "b"});
  ImportOptions options;
  options.mm_per_unit = 2.0;
  options.body = "b";
  const MeshImport b = import_mesh(path, options);
  check_box(b, 2.0);
  CHECK(b.mesh.groups == std::vector<std::string>{"b:x", "b:y"});
  options.body = "c";
  CHECK_THROWS_WITH_AS(import_mesh(path, options), doctest::Contains("its bodies are \"a\", \"b\""),
                       InputError);
}

TEST_CASE("A format without bodies has none to choose") {
  ImportOptions options;
  options.mm_per_unit = 1.0;
  options.body = "crystal";
  const std::string text = "OFF\n8 6 12\n" + corner_lines("") + quad_lines("4 ", 0);
  const MeshImport plain = import_mesh(mesh_file("plain.off", text), 1.0);
  CHECK(plain.bodies.size() <= 1);
  CHECK_THROWS_WITH_AS(import_mesh(mesh_file("plain.off", text), options), doctest::Contains("\"crystal\""),
                       InputError);
}

TEST_CASE("OBJ groups are object and material, and either half selects") {
  std::string text = corner_lines("v ") + "o crystal\nusemtl ground\n";
  const std::string faces = quad_lines("f ", 1);
  const std::size_t last = faces.rfind("f ");
  text += faces.substr(0, last) + "usemtl polished\n" + faces.substr(last);
  const MeshImport read = import_mesh(mesh_file("groups.obj", text), 1.0);
  CHECK(read.mesh.groups == std::vector<std::string>{"crystal:ground", "crystal:polished"});
  const auto count = [&read](const std::string& group) {
    FaceSelector selector;
    selector.group = group;
    const auto mask = select_triangles(read.mesh, selector);
    return std::count(mask.begin(), mask.end(), 1);
  };
  CHECK(count("crystal") == 12);
  CHECK(count("polished") == 2);
  CHECK(count("crystal:ground") == 10);
  CHECK(count("polish") == 0);
}

TEST_CASE("glTF is in metres, moves with its nodes, and its materials are groups") {
  // Turned by 90 degrees about z: (x, y, z) -> (-y, x, z); then scaled before, moved after.
  const std::string node =
      R"({"mesh":0,"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678],"scale":[2,1,1]})";
  const MeshImport read = import_mesh(mesh_file("box.gltf", gltf_text(embedded(), node)), 0.0);
  CHECK(read.unit_from_file == "m");
  CHECK(read.mesh.volume() == doctest::Approx(12e9).epsilon(1e-6));
  CHECK(diagnose(read.mesh).sound());
  const auto bounds = diagnose(read.mesh).bounds;
  CHECK((bounds.min() - Vec3(8000, 0, 0)).norm() < 0.01);
  CHECK((bounds.max() - Vec3(10000, 2000, 3000)).norm() < 0.01);
  CHECK(read.mesh.groups == std::vector<std::string>{"ground", "polished"});
  FaceSelector selector;
  selector.group = "polished";
  const auto mask = select_triangles(read.mesh, selector);
  CHECK(std::count(mask.begin(), mask.end(), 1) == 2);
  for (std::size_t t = 0; t < mask.size(); ++t) {
    if (mask[t]) CHECK(read.mesh.area_vector(t).normalized().z() == doctest::Approx(1.0));
  }
}

TEST_CASE("glTF extras are tags of groups: of node, mesh, material and primitive, the later ones winning") {
  std::string text =
      gltf_text(embedded(), R"({"name":"crystal","mesh":0,"extras":{"finish":"rough","layer":3,)"
                            R"("coated":true,"list":[1],"scale":0.5}})");
  const auto insert = [&text](const std::string& before, const std::string& extras) {
    text.insert(text.find(before) + before.size(), extras);
  };
  insert(R"("name":"polished")", R"(,"extras":{"finish":"smooth","paint":"no"})");
  insert(R"("indices":2,"material":1)", R"(,"extras":{"paint":"white"})");
  const TriMesh mesh = import_mesh(mesh_file("extras.gltf", text), 0.0).mesh;
  CHECK(mesh.groups == std::vector<std::string>{"ground", "polished"});
  CHECK(mesh.tags_of(0) ==
        FaceTags{{"finish", "rough"}, {"layer", "3"}, {"coated", "true"}, {"scale", "0.5"}});
  CHECK(mesh.tags_of(1).at("finish") == "smooth");
  CHECK(mesh.tags_of(1).at("paint") == "white");
  FaceSelector selector;
  selector.tags = {{"layer", "3"}, {"finish", "rough"}};
  const auto mask = select_triangles(mesh, selector);
  CHECK(std::count(mask.begin(), mask.end(), 1) == 10);
  selector.tags["paint"] = "white";
  const auto none = select_triangles(mesh, selector);
  CHECK(std::count(none.begin(), none.end(), 1) == 0);
}

TEST_CASE("A glTF node is a body") {
  const std::string nodes = R"({"name":"a","mesh":0},{"name":"b","mesh":0,"translation":[5,0,0]})";
  std::string text = gltf_text(embedded(), nodes);
  text.replace(text.find("[0]}]"), 3, "[0,1]");
  const std::filesystem::path path = mesh_file("nodes.gltf", text);
  CHECK(import_mesh(path, 0.0).bodies == std::vector<std::string>{"a", "b"});
  ImportOptions options;
  options.body = "b";
  const MeshImport b = import_mesh(path, options);
  check_box(b, 1000.0);
  CHECK(diagnose(b.mesh).bounds.min().x() == doctest::Approx(5000.0));
}

// Fails when the loader comes from libdraco's copy of tinygltf instead of libtinygltf
// (src/mesh/CMakeLists.txt).
TEST_CASE("glTF buffers may lie beside the file") {
  mesh_file("box.bin", gltf_buffer());
  check_box(import_mesh(mesh_file("external.gltf", gltf_text(R"(,"uri":"box.bin")", R"({"mesh":0})")), 1.0),
            1.0);
}

TEST_CASE("glTF buffers may lie in a glb; a given unit replaces the metre") {
  check_box(import_mesh(mesh_file("box.glb", glb(gltf_text("", R"({"mesh":0})"), gltf_buffer())), 1.0), 1.0);
}

TEST_CASE("A mirroring glTF node keeps the box outward") {
  const std::string node = R"({"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  check_box(import_mesh(mesh_file("mirror.gltf", gltf_text(embedded(), node)), 1.0), 1.0);
}

TEST_CASE("A triangle without area is kept out and its neighbour cut, so that the box stays closed") {
  // The edge 0-1 has the extra vertex 8 in its middle: one side uses it, the other has a sliver 0 8 1.
  const std::string text = corner_lines("v ") + "v 0.5 0 0\n" +
                           "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 5 6 8 7\n"
                           "f 1 3 4 2 9\nf 1 9 2\n";
  const MeshImport read = import_mesh(mesh_file("sliver.obj", text), 1.0);
  CHECK(read.degenerate_triangles >= 1);
  CHECK(read.mesh.volume() == doctest::Approx(6.0).epsilon(1e-6));
  CHECK(diagnose(read.mesh).sound());
  REQUIRE(read.notes.size() == 1);
  CHECK(read.notes[0].find("without area kept out") != std::string::npos);
}

TEST_CASE("Vertices two single-precision steps apart are one, four steps apart are two") {
  const auto mesh_with_gap = [](double gap) {
    std::ostringstream text;
    text.precision(17);
    text << corner_lines("v ") << "v " << 1.0 << " " << 2.0 << " " << 3.0 - gap << "\n";
    text << "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 9 7\n";
    return text.str();
  };
  const double step = std::ldexp(1.0, -22);  // spacing of single precision between 2 and 4
  CHECK(diagnose(import_mesh(mesh_file("near.obj", mesh_with_gap(2 * step)), 1.0).mesh).closed());
  CHECK_FALSE(diagnose(import_mesh(mesh_file("far.obj", mesh_with_gap(4 * step)), 1.0).mesh).closed());
}

TEST_CASE("Polygons that are not convex are cut inside themselves") {
  // An L of area 3 in a tilted plane.
  const Frame frame = Frame::about(Vec3(1, 2, 3).normalized());
  std::vector<Vec3> corners;
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{1, 1}, {1, 2}, {0, 2}, {0, 0}, {2, 0}, {2, 1}}) {
    corners.push_back(x * frame.x + y * frame.y);
  }
  bool simple = true;
  Vec3 total = Vec3::Zero();
  double area = 0.0;
  for (const auto& [a, b, c] : triangulate_polygon(corners, simple)) {
    const Vec3 vector = 0.5 * (corners[b] - corners[a]).cross(corners[c] - corners[a]);
    total += vector;
    area += vector.norm();
  }
  CHECK(simple);
  CHECK(area == doctest::Approx(3.0));
  CHECK(total.dot(frame.z) == doctest::Approx(3.0));
  std::swap(corners[1], corners[4]);
  triangulate_polygon(corners, simple);
  CHECK_FALSE(simple);
}
