#include "doctor/doctor_scenes.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::scene;
using namespace scintray::test;

// Two tessellations of one curved surface, made one within a tolerance.

namespace {

constexpr double kRadius = 5.0;  // mm

/// Area of the regular polygon with its corners on the circle, mm2.
double polygon_area(int corners) { return 0.5 * corners * kRadius * kRadius * std::sin(kTwoPi / corners); }
double polygon_perimeter(int corners) { return 2.0 * corners * kRadius * std::sin(kPi / corners); }

/// A block of 12 x 12 x 10 mm from z = low up with a bore of flat sides along z, as a file; or the half
/// of it on the side of negative x.
std::string bored_block(double low = 0.0, int sides = 64, bool half = false) {
  const auto path = scratch_folder("curved") / fmt::format("holder{}_{}_{}.stl", low, sides, half);
  TriMesh bore = make_cylinder(kRadius, 12.0, sides);
  for (Vec3& v : bore.vertices) v.z() -= 1.0;
  auto block = boolean(make_box({-6, -6, 0}, {6, 6, 10}), bore, BooleanOperation::subtract, 1e-9);
  REQUIRE(block);
  if (half) block = boolean(block->mesh, make_box({0, -9, -1}, {9, 9, 11}), BooleanOperation::subtract, 1e-9);
  REQUIRE(block);
  for (Vec3& v : block->mesh.vertices) v.z() += low;
  write_stl(path, block->mesh);
  return path.string();
}

/// A bonded contact with a tolerance of its own.
std::string within(const std::string& a, const std::string& b, const std::string& tolerance) {
  return fmt::format("[[contact]]\nbetween = [\"{}\", \"{}\"]\nkind = \"bonded\"\ntolerance = \"{}\"\n", a, b,
                     tolerance);
}

/// A rod of 48 sides from z = low, `height` long, in the bored block; `turn` is added to both parts.
std::string rod_in_bore(double low, double height, const std::string& tolerance,
                        const std::string& turn = "") {
  const std::string put =
      turn.empty() ? fmt::format("translate = [\"0 mm\", \"0 mm\", \"{} mm\"]\n", low) : turn + "\n";
  const std::string rod =
      fmt::format("cylinder = {{ radius = \"5 mm\", height = \"{} mm\", segments = 48 }}\n", height);
  return lit_scene(part_text("rod", rod + put, "lso") +
                       part_text("holder", from_file(bored_block()) + turn + "\n", "n15") +
                       within("rod", "holder", tolerance),
                   "rod", 2000);
}

/// The rod from z = 0 to 10, half in the bore of a block from z = -5 to 5; `turn` is added to both.
std::string half_entered(const std::string& turn) {
  return lit_scene(
      part_text("rod", "cylinder = { radius = \"5 mm\", height = \"10 mm\", segments = 48 }\n" + turn + "\n",
                "lso") +
          part_text("holder", from_file(bored_block(-5.0)) + turn + "\n", "n15") +
          within("rod", "holder", "20 um"),
      "rod", 2000);
}

}  // namespace

TEST_CASE(
    "A rod of 48 sides flush in a bore of 64: the holder takes the rod's sides, and nothing is left "
    "between") {
  for (const char* turn : {"", "rotate = { axis = [3, 1, 2], angle = \"40 deg\" }"}) {
    CAPTURE(turn);
    const Traced traced = trace(rod_in_bore(0.0, 10.0, "20 um", turn));
    const Scene& scene = traced.built.scene;
    CHECK(scene.parts[PartId(0)].volume_mm3 == doctest::Approx(10.0 * polygon_area(48)).epsilon(1e-9));
    CHECK(scene.parts[PartId(1)].volume_mm3 ==
          doctest::Approx(1440.0 - 10.0 * polygon_area(48)).epsilon(1e-6));
    CHECK(area_between(scene, "rod", "holder") ==
          doctest::Approx(10.0 * polygon_perimeter(48)).epsilon(1e-6));
    REQUIRE(traced.built.parts[1].notes.size() == 1);
    CHECK(contains(traced.built.parts[1].notes[0], "took the shape of \"rod\""));
    // Some corners of the 64 lie over middles of the 48 sides: the deepest sliver is r (1 - cos(pi / 48)).
    CHECK(contains(traced.built.parts[1].notes[0], "moved by up to 0.011 mm"));
  }
}

TEST_CASE("A rod that sticks out of the bore on both sides") {
  const Traced traced = trace(rod_in_bore(-2.0, 14.0, "20 um"));
  const Scene& scene = traced.built.scene;
  CHECK(scene.parts[PartId(1)].volume_mm3 == doctest::Approx(1440.0 - 10.0 * polygon_area(48)).epsilon(1e-6));
  CHECK(area_between(scene, "rod", "holder") == doctest::Approx(10.0 * polygon_perimeter(48)).epsilon(1e-6));
}

TEST_CASE("A rod that ends within the bore conforms to the bore's sides") {
  const Traced traced = trace(rod_in_bore(2.0, 6.0, "20 um"));
  const Scene& scene = traced.built.scene;
  CHECK(scene.parts[PartId(0)].volume_mm3 == doctest::Approx(6.0 * polygon_area(64)).epsilon(1e-6));
  CHECK(area_between(scene, "rod", "holder") == doctest::Approx(6.0 * polygon_perimeter(64)).epsilon(1e-6));
}

TEST_CASE("A ball in a hollow of other triangles") {
  const auto path = scratch_folder("hollow") / "block.stl";
  const auto block =
      boolean(make_box({-7, -7, -7}, {7, 7, -1}), make_sphere(kRadius, 10), BooleanOperation::subtract, 1e-9);
  REQUIRE(block);
  write_stl(path, block->mesh);
  const auto ball_path = scratch_folder("ball") / "ball.stl";
  const TriMesh ball = transformed(make_sphere(kRadius, 13),
                                   Eigen::Affine3d(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized())));
  write_stl(ball_path, ball);
  const Traced traced = trace(lit_scene(part_text("ball", from_file(ball_path.string()), "lso") +
                                            part_text("block", from_file(path.string()), "n15") +
                                            within("ball", "block", "60 um"),
                                        "ball", 2000));
  const Scene& scene = traced.built.scene;
  CHECK(scene.parts[PartId(0)].volume_mm3 == doctest::Approx(ball.volume()).epsilon(1e-6));
  // The cap of a sphere below z = -1: 2 pi r (r - 1), less what a tessellation lacks.
  CHECK(area_between(scene, "ball", "block") ==
        doctest::Approx(kTwoPi * kRadius * (kRadius - 1.0)).epsilon(0.02));
}

TEST_CASE("A rod that enters a bore halfway: each face ends within the other, and both are stitched there") {
  for (const char* turn : {"", "rotate = { axis = [3, 1, 2], angle = \"40 deg\" }"}) {
    CAPTURE(turn);
    const Traced traced = trace(half_entered(turn));
    const Scene& scene = traced.built.scene;
    // The rod keeps its shape, and the contact is its sides from z = 0 to 5.
    CHECK(scene.parts[PartId(0)].volume_mm3 == doctest::Approx(10.0 * polygon_area(48)).epsilon(1e-9));
    CHECK(area_between(scene, "rod", "holder") == doctest::Approx(5.0 * polygon_perimeter(48)).epsilon(1e-6));
    CHECK(area_between(scene, "rod", "ambient") ==
          doctest::Approx(5.0 * polygon_perimeter(48) + 2.0 * polygon_area(48)).epsilon(1e-6));
    // Below, the bore leans from its own 64 sides to the rod's 48: its area there lies between the two.
    const double above = 1440.0 - 5.0 * polygon_area(48);
    const double smaller = std::min(polygon_area(48), polygon_area(64)), larger = kPi * kRadius * kRadius;
    CHECK(scene.parts[PartId(1)].volume_mm3 > above - 5.0 * larger);
    CHECK(scene.parts[PartId(1)].volume_mm3 < above - 5.0 * smaller);
    REQUIRE(traced.built.parts[1].notes.size() == 1);
    CHECK(contains(traced.built.parts[1].notes[0], "stitched to \"rod\""));
    CHECK(contains(traced.built.parts[1].notes[0], "moved by up to 0.011 mm"));
  }
}

TEST_CASE("Staggered contacts with other numbers of sides, in either order, and in half a bore") {
  struct Case {
    int rod_sides, bore_sides;
    bool rod_first, half;
    const char* tolerance;
  };
  for (const Case& c : {Case{64, 96, true, false, "7 um"}, Case{96, 64, true, false, "7 um"},
                        Case{48, 64, false, false, "20 um"}, Case{31, 64, true, false, "30 um"},
                        Case{48, 64, true, true, "20 um"}, Case{64, 96, false, true, "7 um"}}) {
    CAPTURE(c.rod_sides);
    CAPTURE(c.bore_sides);
    CAPTURE(c.half);
    const std::string first = c.rod_first ? "rod" : "holder", second = c.rod_first ? "holder" : "rod";
    const std::string rod = fmt::format(
        "cylinder = {{ radius = \"5 mm\", height = \"10 mm\", segments = {} }}\nrotate = {{ axis = [0, 0, "
        "1], "
        "angle = \"1.3 deg\" }}\n",
        c.rod_sides);
    const std::string text =
        lit_scene(part_text("rod", rod, "lso") +
                      part_text("holder", from_file(bored_block(-5.0, c.bore_sides, c.half)), "n15") +
                      within(first, second, c.tolerance),
                  "rod", 2000);
    const Traced traced = trace(text);
    const Scene& scene = traced.built.scene;
    const int sides = c.rod_first ? c.rod_sides : c.bore_sides;
    const double share = c.half ? 0.5 : 1.0;
    CHECK(area_between(scene, "rod", "holder") ==
          doctest::Approx(5.0 * share * polygon_perimeter(sides)).epsilon(c.half ? 2e-3 : 1e-6));
    check_propagation(scene, scene_spec(text).source, 300);
  }
}

TEST_CASE("Contacts that cannot be closed are reported: tolerances too small, no faces") {
  check_contains(refusal(rod_in_bore(0.0, 10.0, "5 um")), {"cannot be closed", "0.005 mm"});
  check_contains(refusal(rod_in_bore(20.0, 10.0, "20 um")), {"no faces", "face each other"});
}
