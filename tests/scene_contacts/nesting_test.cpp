#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "shapes.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::contact;
using namespace scintray::test;

namespace {

std::vector<std::string> complaints(const std::vector<PlacedPart>& parts, double tolerance = kTolerance) {
  std::vector<std::string> result;
  for (const Problem& problem : problems_of([&] { static_cast<void>(resolve_contacts(parts, tolerance)); }))
    result.push_back(problem.text());
  return result;
}

}  // namespace

TEST_CASE("A part within a part borders it, to any depth and in any order") {
  const auto outer = box("outer", {0, 0, 0}, {10, 10, 10}, 0),
             middle = box("middle", {2, 2, 2}, {8, 8, 8}, 6, 2),
             inner = box("inner", {3, 3, 3}, {5, 5, 5}, 12);
  for (const bool reversed : {false, true}) {
    const std::vector<PlacedPart> parts =
        reversed ? std::vector{inner, middle, outer} : std::vector{outer, middle, inner};
    const PartId o(reversed ? 2 : 0), i(reversed ? 0 : 2);
    const auto interfaces = resolve_contacts(parts, kTolerance);
    CHECK(area_between(interfaces, o, kAmbient) == doctest::Approx(600.0).epsilon(1e-14));
    CHECK(area_between(interfaces, o, PartId(1)) == doctest::Approx(216.0).epsilon(1e-14));
    CHECK(area_between(interfaces, PartId(1), i) == doctest::Approx(24.0).epsilon(1e-14));
    CHECK(area_between(interfaces, i, kAmbient) == 0.0);
    for (const InterfaceTriangle& t : interfaces) CHECK(t.front_face == FaceId::none());
    check_laws(parts, interfaces, reversed ? std::vector{8.0, 208.0, 784.0} : std::vector{784.0, 208.0, 8.0});
  }
}

TEST_CASE("A nested part flush with a face of its container reaches the outside there") {
  for (const bool turned : {false, true}) {
    std::vector<PlacedPart> parts{
        box("block", {0, 0, 0}, {10, 10, 10}, 0, 3), box("plug", {2, 3, 6}, {5, 7, 10}, 6, 2),
        box("core", {3, 4, 8}, {4, 5, 10}, 12), box("pad", {2.5, 3.5, 10}, {8, 8, 11}, 18)};
    if (turned) move(parts, skew_rotation(), Vec3(-3, 2, 1));
    const auto interfaces = resolve_contacts(parts, kTolerance);
    CHECK(area_between(interfaces, PartId(0), PartId(1)) == doctest::Approx(12.0 + 2 * 4 * 7).epsilon(1e-12));
    CHECK(area_between(interfaces, PartId(1), PartId(2)) == doctest::Approx(1.0 + 4 * 2).epsilon(1e-12));
    CHECK(area_between(interfaces, PartId(2), PartId(3)) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(area_between(interfaces, PartId(1), PartId(3)) == doctest::Approx(2.5 * 3.5 - 1.0).epsilon(1e-12));
    CHECK(area_between(interfaces, PartId(1), kAmbient) == doctest::Approx(12.0 - 2.5 * 3.5).epsilon(1e-12));
    CHECK(area_between(interfaces, PartId(0), PartId(3)) ==
          doctest::Approx(5.5 * 4.5 - 2.5 * 3.5).epsilon(1e-12));
    check_laws(parts, interfaces, {1000.0 - 48.0, 46.0, 2.0, 24.75});
  }
}

TEST_CASE("The face under a flush plug belongs to the plug alone") {
  const std::vector<PlacedPart> parts{box("block", {0, 0, 0}, {10, 10, 10}, 0),
                                      box("plug", {2, 3, 6}, {5, 7, 10}, 6)};
  const auto interfaces = resolve_contacts(parts, kTolerance);
  double plug_top = 0.0;
  for (const InterfaceTriangle& t : interfaces)
    if (t.back == PartId(1) && t.front == kAmbient && t.back_face == FaceId(11) &&
        t.front_face == FaceId::none())
      plug_top += area(t);
  CHECK(plug_top == doctest::Approx(12.0).epsilon(1e-13));
}

TEST_CASE("Neighbours inside one container touch each other and it") {
  const std::vector<PlacedPart> parts{box("resin", {-1, -1, -1}, {5, 3, 3}, 0),
                                      box("a", {0, 0, 0}, {2, 2, 2}, 6),
                                      box("b", {2, 0, 0}, {4, 2, 2}, 12, 3)};
  const auto interfaces = resolve_contacts(parts, kTolerance);
  CHECK(area_between(interfaces, PartId(1), PartId(2)) == doctest::Approx(4.0).epsilon(1e-13));
  CHECK(area_between(interfaces, PartId(0), PartId(1)) == doctest::Approx(20.0).epsilon(1e-13));
  CHECK(area_between(interfaces, PartId(0), PartId(2)) == doctest::Approx(20.0).epsilon(1e-13));
  check_laws(parts, interfaces, {96.0 - 16.0, 8.0, 8.0});
}

TEST_CASE("An overlap names both parts, the exact volume and a point inside") {
  const auto list =
      complaints({box("crystal", {0, 0, 0}, {2, 2, 2}), box("guide", {1, 1, 1.5}, {4, 4, 4}, 6)});
  REQUIRE(list.size() == 1);
  check_contains(list[0], {"'crystal'", "'guide'", "overlap by 0.5 mm3"});
  CHECK(contains(list[0], "for example at (1."));
  CHECK(contains(list[0], "hint: move"));
}

TEST_CASE("A cavity in a part belongs to what fills it, else to the ambient medium") {
  PlacedPart hollow = box("hollow", {0, 0, 0}, {4, 4, 4}, 0);
  PlacedPart cavity = box("", {1, 1, 1}, {3, 3, 3}, 6);
  for (auto& t : cavity.triangles) {
    for (auto& v : t) v += static_cast<std::uint32_t>(hollow.vertices.size());
    std::swap(t[1], t[2]);
  }
  hollow.vertices.insert(hollow.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  hollow.triangles.insert(hollow.triangles.end(), cavity.triangles.begin(), cavity.triangles.end());
  hollow.face.insert(hollow.face.end(), cavity.face.begin(), cavity.face.end());

  const std::vector<PlacedPart> parts{hollow, box("half filling", {1, 1, 1}, {3, 3, 2}, 12, 3)};
  const auto interfaces = resolve_contacts(parts, kTolerance);
  CHECK(area_between(interfaces, PartId(0), PartId(1)) == doctest::Approx(4.0 + 8.0).epsilon(1e-13));
  CHECK(area_between(interfaces, PartId(1), kAmbient) == doctest::Approx(4.0).epsilon(1e-13));
  CHECK(area_between(interfaces, PartId(0), kAmbient) == doctest::Approx(96.0 + 12.0).epsilon(1e-13));
  check_laws(parts, interfaces, {56.0, 4.0});

  // What reaches through the wall overlaps with the wall alone.
  const auto list = complaints({hollow, box("rod", {1.5, 1.5, 2.5}, {2.5, 2.5, 9}, 12)});
  REQUIRE(list.size() == 1);
  check_contains(list[0], {"'hollow'", "'rod'", "overlap by 1 mm3"});
}

TEST_CASE("The overlap of a turned pair is exact, that of fine meshes is counted and marked as such") {
  std::vector<PlacedPart> turned{box("a", {0, 0, 0}, {2, 2, 2}), box("b", {1, 1, 1.5}, {4, 4, 4}, 6)};
  move(turned, skew_rotation(), Vec3(1, 2, 3));
  const auto exact = complaints(turned);
  REQUIRE(exact.size() == 1);
  CHECK(contains(exact[0], "overlap by 0.5 mm3,"));
  const auto counted =
      complaints({box("a", {0, 0, 0}, {2, 2, 2}, 0, 7), box("b", {1, 1, 1.5}, {4, 4, 4}, 6, 7)});
  REQUIRE(counted.size() == 1);
  check_contains(counted[0], {"overlap by about 0.5 mm3", "32768 points"});
}

TEST_CASE("All overlapping pairs of three parts are listed") {
  const auto list =
      complaints({box("a", {0, 0, 0}, {2, 2, 2}), box("b", {1, 1, 1}, {3, 3, 3}, 6),
                  box("c", {1.5, 0.5, 1.5}, {4, 4, 4}, 12), box("apart", {9, 9, 9}, {10, 10, 10}, 18)});
  REQUIRE(list.size() == 3);
  check_contains(list[0], {"'a'", "'b'", "overlap by 1 mm3"});
  check_contains(list[1], {"'a'", "'c'", "overlap by 0.375 mm3"});
  check_contains(list[2], {"'b'", "'c'", "overlap by 4.5 mm3"});
}

TEST_CASE("Overlaps without any transversal crossing of surfaces are found") {
  SUBCASE("identical parts") {
    const auto list = complaints({box("a", {0, 0, 0}, {1, 2, 3}), box("b", {0, 0, 0}, {1, 2, 3}, 6, 2)});
    REQUIRE(list.size() == 1);
    CHECK(contains(list[0], "overlap by 6 mm3"));
  }
  SUBCASE("a common cross-section") {
    const auto list = complaints({box("a", {0, 0, 0}, {1, 1, 1}), box("b", {0, 0, 0.75}, {1, 1, 2}, 6)});
    REQUIRE(list.size() == 1);
    CHECK(contains(list[0], "overlap by 0.25 mm3"));
  }
  SUBCASE("a common triangular cross-section, without edges across") {
    const std::vector<Eigen::Vector2d> outline{{0, 0}, {2, 0}, {0, 2}};
    const auto list = complaints({prism("a", outline, 0, 1), prism("b", outline, 0.5, 2, 6)});
    REQUIRE(list.size() == 1);
    CHECK(contains(list[0], "overlap by 1 mm3"));
  }
  SUBCASE("a face through two edges of a box") {
    const auto list =
        complaints({box("a", {0, 0, 0}, {1, 1, 1}), prism("b", {{-9, -9}, {9, 9}, {-9, 27}}, -4, 6, 6)});
    REQUIRE(list.size() == 1);
    CHECK(contains(list[0], "overlap by 0.5 mm3"));
  }
  SUBCASE("crossed bars, no corner in the other") {
    const auto list = complaints({box("a", {-5, -1, 0}, {5, 1, 1}), box("b", {-1, -5, 0.9}, {1, 5, 2}, 6)});
    REQUIRE(list.size() == 1);
    CHECK(contains(list[0], "overlap by 0.4 mm3"));
  }
}

TEST_CASE("Reaching in by less than the tolerance is touching, by more is an overlap") {
  for (const bool turned : {false, true}) {
    CAPTURE(turned);
    const auto with_depth = [&](double depth) {
      // An edge-on prism over a box: no faces touch, only the edge reaches in.
      std::vector<PlacedPart> parts{box("base", {-2, -2, -2}, {2, 2, 0}, 0),
                                    prism("wedge", {{0, -depth}, {1, 1}, {-1, 1}}, -1, 1, 6)};
      for (Vec3& v : parts[1].vertices) v = Vec3(v.x(), -v.z(), v.y());
      if (turned) move(parts, skew_rotation(), Vec3(1, 2, 3));
      return complaints(parts).size();
    };
    CHECK(with_depth(-0.5 * kTolerance) == 0);
    CHECK(with_depth(0.5 * kTolerance) == 0);
    CHECK(with_depth(2.0 * kTolerance) == 1);
    const auto face_to_face = [&](double depth) {
      std::vector<PlacedPart> parts{box("base", {-2, -2, -2}, {2, 2, 0}, 0),
                                    box("top", {-1, -1, -depth}, {1, 1, 1}, 6)};
      if (turned) move(parts, skew_rotation(), Vec3(1, 2, 3));
      return complaints(parts).size();
    };
    CHECK(face_to_face(0.9 * kTolerance) == 0);
    CHECK(face_to_face(2.0 * kTolerance) == 1);
  }
}

TEST_CASE("A part inside out, a part thinner than the tolerance, and a bad tolerance are refused") {
  auto inside_out = box("sleeve", {0, 0, 0}, {1, 1, 1});
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  const auto list = complaints({inside_out, box("film", {3, 0, 0}, {4, 1, 1e-4}, 6)});
  REQUIRE(list.size() == 2);
  check_contains(list[0], {"'sleeve'", "volume of -1 mm3"});
  check_contains(list[1], {"'film'", "0.0001 mm thick"});
  const std::vector<PlacedPart> fine{box("a", {0, 0, 0}, {1, 1, 1})};
  CHECK(complaints(fine, 0.0).size() == 1);
  CHECK(complaints(fine, std::nan("")).size() == 1);
  check_contains(complaints(fine, 1e-15).at(0), {"below the precision", "coordinates"});
}
