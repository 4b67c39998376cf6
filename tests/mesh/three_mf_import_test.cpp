// 3MF files.
#include "mesh/box_files.hpp"
#include "support/zipped.hpp"

using namespace scintray;
using namespace scintray::mesh;
using namespace scintray::test;

namespace {

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
  return zipped({{"_rels/.rels", relationships}, {"3D/3dmodel.model", model}}, true);
}

}  // namespace

TEST_CASE("3MF is in the unit of its model, millimetres when it names none") {
  const std::pair<const char*, double> units[] = {{"", 1.0},
                                                  {" unit=\"micron\"", 1e-3},
                                                  {" unit=\"millimeter\"", 1.0},
                                                  {" unit=\"centimeter\"", 10.0},
                                                  {" unit=\"inch\"", 25.4},
                                                  {" unit=\"foot\"", 304.8},
                                                  {" unit=\"meter\"", 1000.0}};
  for (const auto& row : units) {
    const auto& unit = row.first;
    const auto& mm = row.second;
    CAPTURE(unit);
    check_box(import_mesh(mesh_file("box.3mf", three_mf(unit)), 0.0), mm);
  }
  check_refused(mesh_file("inch.3mf", three_mf(" unit=\"inch\"")), 1.0, "unit inch (25.4 mm)");
  check_refused(mesh_file("bad.3mf", three_mf(" unit=\"ell\"")), 0.0, "is in \"ell\"");
}

TEST_CASE("3MF: components are placed, base materials are groups, and what leads nowhere is refused") {
  const auto model = [](const std::string& objects, const std::string& build) {
    return mesh_file("made.3mf",
                     zipped({{"_rels/.rels", ""},
                             {"3D/3dmodel.model", "<model><resources>" + objects + "</resources><build>" +
                                                      build + "</build></model>"}}));
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
  check_refused(model(objects, "<item objectid=\"3\"/>"), 0.0, {"object \"3\"", "not exist"});
  check_refused(model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>",
                      "<item objectid=\"1\"/>"),
                0.0, "contain themselves");
  std::string doubling = "<object id=\"0\"><mesh>" + tetrahedron + "</mesh></object>";
  for (int level = 1; level <= 60; ++level)
    doubling += "<object id=\"" + std::to_string(level) + "\"><components><component objectid=\"" +
                std::to_string(level - 1) + "\"/><component objectid=\"" + std::to_string(level - 1) +
                "\"/></components></object>";
  check_refused(model(doubling, "<item objectid=\"60\"/>"), 0.0, "multiply to more than");
  check_refused(
      model("<object id=\"1\"><mesh><vertices><vertex x=\"a\" y=\"0\" z=\"0\"/></vertices></mesh></object>",
            ""),
      0.0, {"x=\"a\"", "not a number"});
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

TEST_CASE("3MF: extensions that a file requires and that carry geometry are refused by name") {
  const auto with = [](const std::string& attributes, const std::string& build = "<item objectid=\"1\"/>") {
    return mesh_file("extension.3mf", three_mf(attributes, build));
  };
  const std::string lattice = " xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\"";
  const std::string others =
      " xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\""
      " xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";
  check_refused(with(lattice + others + " requiredextensions=\"m b\""), 0.0,
                {"requires", "beamlattice/2017/02", "missing"});
  check_refused(with(" requiredextensions=\"x\""), 0.0, {"requires", "\"x\""});
  check_box(import_mesh(with(others + " requiredextensions=\" m  p \""), 0.0), 1.0);
  check_box(import_mesh(with(lattice), 0.0), 1.0);
  check_refused(
      with(others + " requiredextensions=\"p\"", "<item objectid=\"1\" p:path=\"/3D/other.model\"/>"), 0.0,
      "\"/3D/other.model\"");
}
