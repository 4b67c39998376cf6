#include <fmt/format.h>

#include <regex>
#include <tuple>

#include "doctor/doctor_scenes.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::test;

// Overlaps that are meant: the part with the higher priority keeps the space.

namespace {

/// A plate 10 x 10 x 4 mm and a rod of 2 x 2 mm through it, with keys of their own, and a source in the rod.
std::string plate_and_rod(const std::string& plate, const std::string& rod) {
  return lit_scene(part_text("plate", corners({-5, -5, 0}, {5, 5, 4}) + plate, "n15") +
                       part_text("rod", corners({-1, -1, -3}, {1, 1, 7}), "lso") + rod,
                   "rod", 3000);
}

double area_of(const Scene& scene, const std::string& face) {
  for (const FaceInfo& info : scene.faces)
    if (info.name == face) return info.area_mm2;
  return -1.0;
}

}  // namespace

TEST_CASE("The part with the higher priority keeps the space, and the cut is a face of the other") {
  const std::string turned = "rotate = { axis = [1, 2, 3], angle = \"31 deg\" }\n";
  for (const bool skew : {false, true}) {
    CAPTURE(skew);
    const Traced traced = trace(plate_and_rod(skew ? turned : "", "priority = 2\n" + (skew ? turned : "")));
    const Scene& scene = traced.built.scene;
    CHECK(scene.parts[PartId(0)].volume_mm3 == doctest::Approx(400.0 - 16.0).epsilon(1e-9));
    CHECK(scene.parts[PartId(1)].volume_mm3 == doctest::Approx(40.0).epsilon(1e-9));
    CHECK(area_of(scene, "plate:cut:rod") == doctest::Approx(4.0 * 2.0 * 4.0).epsilon(1e-9));
    CHECK(traced.built.parts[0].notes.size() == 1);
    CHECK(contains(traced.built.parts[0].notes[0], "cut by \"rod\""));
    double contact = 0.0;
    for (const InterfaceId i : scene.interfaces.ids())
      if (scene.interfaces[i].back == RegionId(1) && scene.interfaces[i].front == RegionId(2))
        contact += scene.interface_area_mm2[i];
    CHECK(contact == doctest::Approx(32.0).epsilon(1e-9));
  }
}

TEST_CASE("The other way round the plate cuts the rod in two") {
  const Scene scene = SceneBuilder().build(scene_spec(plate_and_rod("priority = 1\n", ""))).scene;
  CHECK(scene.parts[PartId(0)].volume_mm3 == doctest::Approx(400.0));
  CHECK(scene.parts[PartId(1)].volume_mm3 == doctest::Approx(24.0).epsilon(1e-12));
  CHECK(area_of(scene, "rod:cut:plate") == doctest::Approx(8.0).epsilon(1e-12));
}

TEST_CASE("Equal priorities stay an error that names both parts and the volume") {
  for (const char* priority : {"", "priority = 3\n"}) {
    const std::string text = refusal(plate_and_rod(priority, priority));
    check_contains(text, {"'plate'", "'rod'", "overlap by 16 mm3"});
    CHECK(contains(text, "higher priority"));
  }
}

TEST_CASE("Three parts: each is cut by all above it") {
  const std::string third = part_text("post", corners({0, -2, 1}, {2, 2, 9}) + "priority = 1\n", "n15");
  const Scene scene = SceneBuilder().build(scene_spec(plate_and_rod("", "priority = 2\n" + third))).scene;
  // post 2 x 4 x 8 less the rod's 1 x 2 x 6; plate less the rod and what is left of the post in it.
  CHECK(scene.parts[PartId(2)].volume_mm3 == doctest::Approx(64.0 - 12.0).epsilon(1e-9));
  CHECK(scene.parts[PartId(0)].volume_mm3 ==
        doctest::Approx(400.0 - 16.0 - (2.0 * 4.0 - 2.0) * 3.0).epsilon(1e-9));
}

TEST_CASE("Parts that are apart cut another together, each with a face of its own") {
  // Four pins through the plate, and a bar across two of them.
  std::string parts;
  for (const auto& [name, x, y] : {std::tuple("a", -3, -3), {"b", 3, -3}, {"c", -3, 3}, {"d", 3, 3}}) {
    const Eigen::Vector3d low(x - 0.5, y - 0.5, -1.0), high(x + 0.5, y + 0.5, 5.0);
    parts += part_text(name, corners(low, high) + "priority = 2\n", "lso");
  }
  parts += part_text("bar", corners({-5.5, 2.8, 1}, {5.5, 3.2, 3}) + "priority = 1\n", "n15");
  const Traced traced =
      trace(lit_scene(part_text("plate", corners({-5, -5, 0}, {5, 5, 4}), "n15") + parts, "a", 3000));
  const Scene& scene = traced.built.scene;
  const double bar = 11.0 * 0.4 * 2.0 - 2.0 * 1.0 * 0.4 * 2.0, outside = 2.0 * 0.5 * 0.4 * 2.0;
  CHECK(scene.parts[PartId(0)].volume_mm3 ==
        doctest::Approx(400.0 - 4.0 * 4.0 - (bar - outside)).epsilon(1e-9));
  CHECK(scene.parts[PartId(5)].volume_mm3 == doctest::Approx(bar).epsilon(1e-9));
  for (const char* alone : {"plate:cut:a", "plate:cut:b"})
    CHECK(area_of(scene, alone) == doctest::Approx(16.0).epsilon(1e-9));
  for (const char* crossed : {"plate:cut:c", "plate:cut:d"})
    CHECK(area_of(scene, crossed) == doctest::Approx(16.0 - 2.0 * 0.4 * 2.0).epsilon(1e-9));
  CHECK(area_of(scene, "bar:cut:c") == doctest::Approx(2.0 * 0.4 * 2.0).epsilon(1e-9));
  REQUIRE(traced.built.parts[0].notes.size() == 2);
  CHECK(contains(traced.built.parts[0].notes[0], "cut by \"a\" and 3 more"));
  CHECK(contains(traced.built.parts[0].notes[1], "cut by \"bar\""));
}

TEST_CASE("One of several that cannot cut a part is named alone") {
  // The clad rod has a corner on that of the glue around it, where nothing would be left; the pins cut.
  std::string text =
      "[[part]]\nname = \"glue\"\ncylinder = { radius = \"2 mm\", height = \"30 mm\", segments = 32 }\n"
      "medium = \"n15\"\nsurface = \"flat\"\n[[part]]\nname = \"clad\"\ncylinder = { radius = \"1.8 mm\", "
      "height = \"25 mm\", segments = 24 }\ntranslate = [\"0.2 mm\", \"0 mm\", \"-15 mm\"]\nmedium = "
      "\"lso\"\nsurface = \"flat\"\npriority = 3\n";
  for (const int z : {12, 16, 20})
    text += part_text(fmt::format("pin{}", z),
                      corners({-5, -0.5, z - 0.5}, {5, 0.5, z + 0.5}) + "priority = 3\n", "lso");
  const std::string refused = refusal(lit_scene(text, "clad", 10));
  check_contains(refused, {"\"glue\"", "cannot be cut by \"clad\""});
  CHECK_FALSE(contains(refused, "cannot be cut by \"pin"));
}

TEST_CASE("A part wholly inside another is nested, whatever the priorities") {
  const std::string nested =
      lit_scene(part_text("resin", corners({-4, -4, 0}, {4, 4, 9}) + "priority = 5\n", "n15") +
                    part_text("crystal", corners({-1, -1, 1}, {1, 1, 3}), "lso"),
                "crystal", 1000);
  const Traced traced = trace(nested);
  CHECK(traced.built.parts[0].notes.empty());
  CHECK(traced.built.parts[1].notes.empty());
}

TEST_CASE("Glue in a gap is cut like any other part, and needs no surface") {
  // A pin stands in the layer of grease between a crystal and a plate.
  const std::string crystal = part_text("crystal", corners({-2, -2, 0}, {2, 2, 4}), "lso");
  const std::string plate =
      part_text("plate",
                "box = [\"4 mm\", \"4 mm\", \"1 mm\"]\nplace = { touch = \"crystal\", side = "
                "\"+z\", gap = \"0.5 mm\", fill = \"n15\" }\n",
                "n15");
  const std::string pin = part_text("pin", corners({-0.5, -0.5, 4}, {3, 0.5, 4.5}) + "priority = 1\n", "lso");
  const Traced traced = trace(lit_scene(crystal + plate + pin, "crystal", 2000));
  const Scene& scene = traced.built.scene;
  CHECK(area_between(scene, "plate_fill", "pin") == doctest::Approx(0.5 * (1.0 + 2.0 * 2.5)).epsilon(1e-9));
  CHECK(area_of(scene, "plate_fill:cut:pin") == doctest::Approx(3.0).epsilon(1e-9));
}

TEST_CASE("A cut that needs a surface, and one that grazes, are refused with the reason") {
  std::string bare = plate_and_rod("", "priority = 2\n");
  const std::string surface = "medium = \"n15\"\nsurface = \"flat\"\n";
  bare.replace(
      bare.find(surface), surface.size(),
      "medium = \"n15\"\n[[part.face]]\nname = \"all\"\nselect = { box = { low = [\"-9 mm\", \"-9 mm\", "
      "\"-9 mm\"], high = [\"9 mm\", \"9 mm\", \"9 mm\"] } }\nsurface = \"flat\"\n");
  check_contains(refusal(bare), {"faces", "cut", "no surface"});
  CHECK(contains(refusal(plate_and_rod("priority = 1001\n", "")), "a priority beyond 1000"));
}

TEST_CASE("Coaxial cylinders cut each other whatever their numbers of sides") {
  const double pi = 3.14159265358979;
  for (const auto& pair : {std::pair{64, 64}, {64, 48}, {48, 64}, {72, 64}, {32, 64}}) {
    const int outer = pair.first, inner = pair.second;
    CAPTURE(outer);
    CAPTURE(inner);
    const std::string glue =
        "[[part]]\nname = \"glue\"\ncylinder = { radius = \"0.75 mm\", height = \"30 mm\", segments = " +
        std::to_string(outer) + " }\nmedium = \"n15\"\nsurface = \"flat\"\n";
    const std::string clad =
        "[[part]]\nname = \"clad\"\ncylinder = { radius = \"0.5 mm\", height = \"60 mm\", segments = " +
        std::to_string(inner) +
        " }\ntranslate = [\"0 mm\", \"0 mm\", \"-15 mm\"]\nmedium = \"lso\"\nsurface = "
        "\"flat\"\npriority = 3\n";
    const std::string text = lit_scene(glue + clad, "clad", 10);
    const Scene scene = SceneBuilder().build(scene_spec(text + "[run]\ncurved = \"facets\"\n")).scene;
    const auto area = [pi](int sides, double radius) {
      return 0.5 * sides * radius * radius * std::sin(2.0 * pi / sides);
    };
    CHECK(scene.parts[PartId(0)].volume_mm3 ==
          doctest::Approx(30.0 * (area(outer, 0.75) - area(inner, 0.5))).epsilon(1e-6));
    const Scene exact = SceneBuilder().build(scene_spec(text)).scene;
    CHECK(exact.parts[PartId(0)].volume_mm3 ==
          doctest::Approx(30.0 * pi * (0.75 * 0.75 - 0.5 * 0.5)).epsilon(1e-9));
  }
}

TEST_CASE("Where tangent solids cannot be cut, the change of the scene that is advised makes it succeed") {
  // The inner prism has a corner on the outer one's: nothing is left between them there.
  const auto rods = [](double radius, double x) {
    return lit_scene(
        fmt::format(
            "[[part]]\nname = \"glue\"\ncylinder = {{ radius = \"2 mm\", height = \"30 mm\", segments = 32 "
            "}}\nmedium = \"n15\"\nsurface = \"flat\"\n[[part]]\nname = \"clad\"\ncylinder = {{ radius = "
            "\"{} mm\", height = \"60 mm\", segments = 24 }}\ntranslate = [\"{} mm\", \"0 mm\", \"-15 "
            "mm\"]\nmedium = \"lso\"\nsurface = \"flat\"\npriority = 3\n",
            radius, x),
        "clad", 10);
  };
  const std::string refused = refusal(rods(1.8, 0.2));
  check_contains(refused, {"\"glue\"", "cannot be cut by \"clad\""});
  std::smatch words;
  double radius = 1.8, x = 0.2;
  if (std::regex_search(refused, words, std::regex("moved by ([-+0-9.e]+) mm along x")))
    x += std::stod(words[1]);
  else if (std::regex_search(refused, words, std::regex("([0-9.e-]+) mm (larger|smaller) in radius")))
    radius += (words[2] == "larger" ? 1.0 : -1.0) * std::stod(words[1]);
  else
    FAIL("no change is advised: " << refused);
  CAPTURE(refused);
  CHECK_NOTHROW(SceneBuilder().build(scene_spec(rods(radius, x))));
}
