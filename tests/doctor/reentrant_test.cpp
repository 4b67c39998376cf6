#include "physics/traced.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/primitives.hpp"
#include "scintray/mesh/stl_writer.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::test;

// Parts with cavities and notches, from mesh files, traced.

namespace {

std::string write_mesh(const std::string& name, const TriMesh& mesh) {
  const auto path = scratch_folder(name) / (name + ".stl");
  write_stl(path, mesh);
  return path.string();
}

TriMesh less(const TriMesh& whole, const TriMesh& part) {
  const auto result = boolean(whole, part, BooleanOperation::subtract, 1e-9);
  REQUIRE(result);
  return result->mesh;
}

std::string part(const std::string& name, const std::string& shape, const std::string& medium) {
  return "[[part]]\nname = \"" + name + "\"\n" + shape + "medium = \"" + medium + "\"\nsurface = \"flat\"\n";
}

std::string from_file(const std::string& path) { return "mesh = \"" + path + "\"\nunit = \"mm\"\n"; }

std::string corners(const std::string& low, const std::string& high) {
  return "box = { low = " + low + ", high = " + high + " }\n";
}

std::string scene(const std::string& parts, const std::string& start) {
  return "ambient = \"vacuum_n1\"\n" + parts + "[source]\ntype = \"photons\"\nregion = { part = \"" + start +
         "\" }\nwavelength = \"420 nm\"\nphotons = 3000\n";
}

double area_between(const Scene& scene, const std::string& a, const std::string& b) {
  double area = 0.0;
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const std::string &back = scene.regions[scene.interfaces[i].back].name,
                      &front = scene.regions[scene.interfaces[i].front].name;
    if ((back == a && front == b) || (back == b && front == a)) area += scene.interface_area_mm2[i];
  }
  return area;
}

/// Follows photons one by one and looks whether each flight lies in the region it is said to be in.
void check_flights(const Traced& traced, const std::string& text) {
  constexpr double kShort_mm = 0.01;
  const Scene& built = traced.built.scene;
  const PhotonSource source(scene_spec(text).source, built);
  std::size_t flights = 0, astray = 0;
  for (std::uint64_t photon = 0; photon < 200; ++photon) {
    std::optional<Photon> before;
    replay(built, source, {}, 0, photon, [&](const Photon& now, const Step&) {
      if (before && (now.position - before->position).norm() > kShort_mm) {
        ++flights;
        astray += !built.region_contains(before->region, 0.5 * (before->position + now.position));
      }
      before = now;
    });
  }
  CHECK(flights > 200);
  CHECK(astray == 0);
}

}  // namespace

TEST_CASE("A crystal in the notch of a part that reaches round it touches it on three sides") {
  const std::string u =
      write_mesh("u_shape", less(make_box({0, 0, 0}, {6, 4, 6}), make_box({2, -1, 2}, {4, 5, 7})));
  const std::string text = scene(
      part("u", from_file(u), "n15") +
          part("crystal", corners("[\"2 mm\", \"0 mm\", \"2 mm\"]", "[\"4 mm\", \"4 mm\", \"8 mm\"]"), "lso"),
      "crystal");
  const Traced traced = trace(text);
  CHECK(area_between(traced.built.scene, "u", "crystal") == doctest::Approx(2.0 * 16.0 + 8.0).epsilon(1e-6));
  check_flights(traced, text);
}

TEST_CASE("A cavity in a mesh holds the ambient medium, or the part that is put there, flush or floating") {
  const TriMesh block = make_box({0, 0, 0}, {8, 8, 8}), hollow = less(block, make_box({2, 2, 2}, {6, 6, 6}));
  const std::string file = write_mesh("hollow", hollow);
  const std::string shell = part("shell", from_file(file), "n15");
  const std::string fills =
      part("core", corners("[\"2 mm\", \"2 mm\", \"2 mm\"]", "[\"6 mm\", \"6 mm\", \"6 mm\"]"), "lso");
  const std::string floats =
      part("core", corners("[\"3 mm\", \"3 mm\", \"3 mm\"]", "[\"5 mm\", \"5 mm\", \"5 mm\"]"), "lso");

  const std::string empty = scene(shell, "shell");
  const Traced alone = trace(empty);
  CHECK(area_between(alone.built.scene, "shell", "ambient") == doctest::Approx(384.0 + 96.0).epsilon(1e-6));
  check_flights(alone, empty);

  const std::string full = scene(shell + fills, "core");
  const Traced filled = trace(full);
  CHECK(area_between(filled.built.scene, "shell", "core") == doctest::Approx(96.0).epsilon(1e-6));
  CHECK(area_between(filled.built.scene, "core", "ambient") == 0.0);
  check_flights(filled, full);

  const std::string loose = scene(shell + floats, "core");
  const Traced floating = trace(loose);
  CHECK(area_between(floating.built.scene, "shell", "core") == 0.0);
  CHECK(area_between(floating.built.scene, "core", "ambient") == doctest::Approx(24.0).epsilon(1e-6));
  check_flights(floating, loose);
}

TEST_CASE("Crystals glued in rows: pads between neighbours, dry on one side, one frame around all") {
  std::string parts =
      part("frame", corners("[\"-1 mm\", \"-1 mm\", \"-1 mm\"]", "[\"7.2 mm\", \"3 mm\", \"9 mm\"]"), "n15");
  for (int i = 0; i < 3; ++i) {
    const std::string x0 = fmt::format("[\"{:.6g} mm\", \"0 mm\", \"0 mm\"]", 2.1 * i),
                      x1 = fmt::format("[\"{:.6g} mm\", \"2 mm\", \"9 mm\"]", 2.1 * i + 2.0),
                      g0 = fmt::format("[\"{:.6g} mm\", \"0 mm\", \"0 mm\"]", 2.1 * i + 2.0),
                      g1 = fmt::format("[\"{:.6g} mm\", \"2 mm\", \"9 mm\"]", 2.1 * i + 2.1);
    parts += part(fmt::format("crystal{}", i), corners(x0, x1), "lso");
    if (i < 2) parts += part(fmt::format("glue{}", i), corners(g0, g1), "n15");
  }
  parts += "[[contact]]\nbetween = [\"crystal0\", \"frame\"]\nkind = \"dry\"\n";
  const std::string text = scene(parts, "crystal1");
  const Traced traced = trace(text);
  const Scene& built = traced.built.scene;
  for (int i = 0; i < 2; ++i) {
    CHECK(area_between(built, fmt::format("crystal{}", i), fmt::format("glue{}", i)) ==
          doctest::Approx(18.0));
    CHECK(area_between(built, fmt::format("glue{}", i), fmt::format("crystal{}", i + 1)) ==
          doctest::Approx(18.0));
  }
  for (const Interface& interface : built.interfaces) {
    const std::string &back = built.regions[interface.back].name,
                      &front = built.regions[interface.front].name;
    CHECK((interface.gap_medium != kNone) == (back == "crystal0" && front == "frame"));
  }
  CHECK(area_between(built, "crystal1", "frame") == doctest::Approx(2.0 * 18.0 + 4.0));
  check_flights(traced, text);
}
