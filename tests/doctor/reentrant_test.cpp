#include "doctor/doctor_scenes.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::mesh;
using namespace scintray::scene;
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

}  // namespace

TEST_CASE("A crystal in the notch of a part that reaches round it touches it on three sides") {
  const std::string u =
      write_mesh("u_shape", less(make_box({0, 0, 0}, {6, 4, 6}), make_box({2, -1, 2}, {4, 5, 7})));
  const std::string text = lit_scene(
      part_text("u", from_file(u), "n15") + part_text("crystal", corners({2, 0, 2}, {4, 4, 8}), "lso"),
      "crystal", 3000);
  const Traced traced = trace(text);
  CHECK(area_between(traced.built.scene, "u", "crystal") == doctest::Approx(2.0 * 16.0 + 8.0).epsilon(1e-6));
  check_propagation(traced.built.scene, scene_spec(text).source, 200);
}

TEST_CASE("A cavity in a mesh holds the ambient medium, or the part that is put there, flush or floating") {
  const TriMesh block = make_box({0, 0, 0}, {8, 8, 8}), hollow = less(block, make_box({2, 2, 2}, {6, 6, 6}));
  const std::string file = write_mesh("hollow", hollow);
  const std::string shell = part_text("shell", from_file(file), "n15");
  const std::string fills = part_text("core", corners({2, 2, 2}, {6, 6, 6}), "lso");
  const std::string floats = part_text("core", corners({3, 3, 3}, {5, 5, 5}), "lso");

  const std::string empty = lit_scene(shell, "shell", 3000);
  const Traced alone = trace(empty);
  CHECK(area_between(alone.built.scene, "shell", "ambient") == doctest::Approx(384.0 + 96.0).epsilon(1e-6));
  check_propagation(alone.built.scene, scene_spec(empty).source, 200);

  const std::string full = lit_scene(shell + fills, "core", 3000);
  const Traced filled = trace(full);
  CHECK(area_between(filled.built.scene, "shell", "core") == doctest::Approx(96.0).epsilon(1e-6));
  CHECK(area_between(filled.built.scene, "core", "ambient") == 0.0);
  check_propagation(filled.built.scene, scene_spec(full).source, 200);

  const std::string loose = lit_scene(shell + floats, "core", 3000);
  const Traced floating = trace(loose);
  CHECK(area_between(floating.built.scene, "shell", "core") == 0.0);
  CHECK(area_between(floating.built.scene, "core", "ambient") == doctest::Approx(24.0).epsilon(1e-6));
  check_propagation(floating.built.scene, scene_spec(loose).source, 200);
}

TEST_CASE("Crystals glued in rows: pads between neighbours, dry on one side, one frame around all") {
  std::string parts = part_text("frame", corners({-1, -1, -1}, {7.2, 3, 9}), "n15");
  for (int i = 0; i < 3; ++i) {
    const double x = 2.1 * i;
    parts += part_text(fmt::format("crystal{}", i), corners({x, 0, 0}, {x + 2.0, 2, 9}), "lso");
    if (i < 2) parts += part_text(fmt::format("glue{}", i), corners({x + 2.0, 0, 0}, {x + 2.1, 2, 9}), "n15");
  }
  parts += "[[contact]]\nbetween = [\"crystal0\", \"frame\"]\nkind = \"dry\"\n";
  const std::string text = lit_scene(parts, "crystal1", 3000);
  const Traced traced = trace(text);
  const Scene& built = traced.built.scene;
  for (int i = 0; i < 2; ++i) {
    CHECK(area_between(built, fmt::format("crystal{}", i), fmt::format("glue{}", i)) ==
          doctest::Approx(18.0));
    CHECK(area_between(built, fmt::format("glue{}", i), fmt::format("crystal{}", i + 1)) ==
          doctest::Approx(18.0));
  }
  for (const Interface& interface : built.interfaces) {
    const std::string &back = built.region_names[interface.back],
                      &front = built.region_names[interface.front];
    CHECK(interface.gap_medium.has_value() == (back == "crystal0" && front == "frame"));
  }
  CHECK(area_between(built, "crystal1", "frame") == doctest::Approx(2.0 * 18.0 + 4.0));
  check_propagation(traced.built.scene, scene_spec(text).source, 200);
}
