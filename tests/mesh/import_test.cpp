// OBJ, OFF, PLY and STL files, and what holds for every format.
#include <algorithm>
#include <array>
#include <bit>
#include <sstream>

#include "mesh/box_files.hpp"
#include "scintray/mesh/degenerate.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/shapes/polygon.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

TEST_CASE("OBJ, OFF, PLY and ASCII STL are the same box in mm") {
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
  CHECK(read.notes[0].find("without area left out") != std::string::npos);
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

TEST_CASE("Triangles without area in a row along one edge go without leaving a slit") {
  // A tetrahedron O X Y Z; points on its edge X Y belong to the face with O, and slivers join them to X Y Z.
  for (const int points : {1, 2, 3, 7})
    for (const bool from_far_end : {false, true}) {
      CAPTURE(points);
      CAPTURE(from_far_end);
      TriMesh mesh;
      mesh.vertices = {{0, 0, 3}, {0, 0, 0}, {4, 0, 0}, {0, 5, 0}};
      const std::uint32_t o = 0, x = 1, y = 2, z = 3;
      std::vector<std::uint32_t> line{x};
      for (int i = 1; i <= points; ++i) {
        line.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        mesh.vertices.emplace_back(4.0 * i / (points + 1), 0, 0);
      }
      line.push_back(y);
      mesh.triangles = {{x, z, y}, {x, o, z}, {y, z, o}};
      for (std::size_t i = 0; i + 1 < line.size(); ++i) mesh.triangles.push_back({line[i], line[i + 1], o});
      for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        if (from_far_end)
          mesh.triangles.push_back({y, line[i], line[i - 1]});
        else
          mesh.triangles.push_back({x, line[i + 1], line[i]});
      }
      REQUIRE(diagnose(mesh).closed());
      remove_degenerate(mesh, 1e-6);
      const MeshDiagnosis after = diagnose(mesh);
      CHECK(after.sound());
      CHECK(after.volume_mm3 == doctest::Approx(10.0));
    }
}

TEST_CASE("Slivers along a smooth border of close vertices go without leaving a slit") {
  // A prism over a fan of an arc whose steps are far below its size: each vertex is within rounding of the
  // chord of its neighbours. On the lids, nested chords end in slivers that cuts can only move along the arc.
  for (const int steps : {4, 5, 9}) {
    CAPTURE(steps);
    const double radius = 10.0, step_rad = 2e-4;
    TriMesh mesh;
    std::vector<std::uint32_t> low, high;
    const auto add = [&](double x, double y) {
      low.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.emplace_back(x, y, 0.0);
      high.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.emplace_back(x, y, 5.0);
    };
    for (int i = 0; i <= steps; ++i) add(radius * std::cos(i * step_rad), radius * std::sin(i * step_rad));
    add(0.0, 0.0);
    const auto lid = [&](std::size_t a, std::size_t b, std::size_t c) {
      mesh.triangles.push_back({high[a], high[b], high[c]});
      mesh.triangles.push_back({low[c], low[b], low[a]});
    };
    const auto last = static_cast<std::size_t>(steps), middle = last + 1;
    lid(0, last, middle);
    std::size_t from = 0, to = last;  // chords inside chords, drawn in at both ends in turn
    for (bool at_start = true; to - from > 1; at_start = !at_start) {
      if (at_start)
        lid(from, from + 1, to), ++from;
      else
        lid(from, to - 1, to), --to;
    }
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t j = (i + 1) % low.size();
      mesh.triangles.push_back({low[i], low[j], high[j]});
      mesh.triangles.push_back({low[i], high[j], high[i]});
    }
    REQUIRE(diagnose(mesh).closed());
    const double volume = mesh.volume();
    // One ear is a sliver, the next chords are not.
    const double ear_mm = radius * (1.0 - std::cos(step_rad));
    const DegenerateRemoval removal = remove_degenerate(mesh, 1.5 * ear_mm);
    const MeshDiagnosis after = diagnose(mesh);
    CHECK(after.closed());
    CHECK(after.outward());
    CHECK(after.self_intersections.count == 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) CHECK_FALSE(is_degenerate(mesh, t, 1.5 * ear_mm));
    CHECK(removal.merged > 0);
    CHECK(std::abs(after.volume_mm3 - volume) < 2.0 * ear_mm * radius * steps * step_rad * 5.0);
  }
}
