// Parts that do not go together: the message names them and states where both stand.
#include "bad_input/marked_text.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

/// A scene of two boxes, a and b, with `of_a` and `of_b` among their keys, and `more` at the end.
std::string boxes(const std::string& of_a, const std::string& of_b, const std::string& more = "") {
  return "ambient = \"air\"\n@@[[part]]\nname = \"a\"\nmedium = \"thin\"\n" + of_a +
         "[[part]]\nname = \"b\"\nmedium = \"thin\"\n" + of_b + R"([source]
type = "photons"
region = { part = "a" }
wavelength = "420 nm"
photons = 1
[media.thin]
index = { n = { wavelength = [400, 500], wavelength_unit = "nm", value = [1.5, 1.5] } }
absorption = { none = true }
scattering = { none = true }
)" + more;
}

std::vector<Problem> problems_of_scene(const MarkedText& scene) {
  return problems_of([&] { SceneBuilder().build(SceneFile::from_text(scene.text, "scene.toml").spec(0)); });
}

void check_scene(const std::string& marked, const Fragments& what, const Fragments& hint) {
  const MarkedText scene(marked);
  check_one_problem(scene, problems_of_scene(scene), what, hint);
}

const std::string kPolished = "surface = \"polished\"\n";

/// A box of 2 x 2 x 2 mm3 with its low corner on x.
std::string at(const std::string& x, const std::string& x_high) {
  return "box = { low = [\"" + x + " mm\", \"0 mm\", \"0 mm\"], high = [\"" + x_high +
         " mm\", \"2 mm\", \"2 mm\"] }\n";
}

}  // namespace

TEST_CASE("Parts that overlap are reported with the places of both") {
  const std::string scene = boxes(at("0", "2") + kPolished, at("1", "3") + kPolished);
  check_scene(scene, {"'a'", "'b'", "overlap by 4 mm3"}, "move one of them");
  check_scene(scene, {"'b'", "scene.toml:7:1"}, "higher priority");
}

TEST_CASE("Bonded faces of different surfaces are reported with the places of both parts") {
  check_scene(boxes(at("0", "2") + kPolished, at("2", "4") + "surface = \"roncali2013_unified_rough\"\n"),
              {"interface", "one surface", "'b'", "scene.toml:7:1"}, "add [[contact]]");
}

TEST_CASE("With a contact, its place is reported") {
  std::string scene =
      boxes(at("0", "2") + kPolished, at("2", "4") + "surface = \"roncali2013_unified_rough\"\n",
            "@@[[contact]]\nbetween = [\"a\", \"b\"]\nkind = \"bonded\"\n");
  scene.erase(scene.find("@@"), 2);
  check_scene(scene, {"interface", "one surface", "'b'", "scene.toml:7:1"}, "the joint");
}

TEST_CASE("A part thinner than the contact tolerance is reported with its place") {
  check_scene(boxes(at("0", "2e-4") + kPolished, at("4", "6") + kPolished), "part 'a' is about",
              "lower the contact tolerance");
}

TEST_CASE("A part that another one covers entirely is reported with the places of both") {
  check_scene(boxes(at("0", "2") + kPolished, at("-0.00000001", "2") + kPolished + "priority = 1\n"),
              {"nothing", "left", "'b'", "scene.toml:7:1"}, "change the priorities");
}

TEST_CASE("Principal axes of a birefringent medium: two perpendicular directions, of such a medium alone") {
  const auto scene = [](const std::string& of_a, const std::string& more = "") {
    return boxes(at("0", "2") + kPolished + of_a, at("4", "6") + kPolished, more);
  };
  const auto spar = [&](const std::string& of_a) {
    std::string text =
        scene(of_a,
              "[media.spar]\nindex = { n = 1.6, z = { n = 1.5 } }\nabsorption = { none = true }\n"
              "scattering = { none = true }\n");
    return replaced(std::move(text), "name = \"a\"\nmedium = \"thin\"", "name = \"a\"\nmedium = \"spar\"");
  };
  check_scene(scene("principal_axes = { z = [0, 0, 1] }\n"),
              {"\"a\" has principal axes", "one refractive index"}, {"[index.z]"});
  const auto marked_at_key = [](std::string text, const std::string& key) {
    text.erase(text.find("@@"), 2);
    return text.insert(text.find(key), "@@");
  };
  check_scene(marked_at_key(spar("principal_axes = { z = [0, 0, 1], x = [1, 0, 1] }\n"), "[1, 0, 1]"),
              {"not perpendicular"}, {"check the two directions"});
  check_scene(marked_at_key(spar("principal_axes = { x = [1, 0, 0] }\n"), "{ x = [1, 0, 0]"), {"no \"z\""},
              {"z = [0, 0, 1]"});
  const std::string biaxial =
      replaced(spar("principal_axes = { z = [0, 0, 1] }\n"), "z = { n = 1.5 }", "y = { n = 1.5 }");
  check_scene(biaxial, {"z alone", "\"spar\" differs along x and y"}, {"x as well"});
  std::string ambient = replaced(spar(""), "ambient = \"air\"", "ambient = \"spar\"");
  check_scene(marked_at_key(std::move(ambient), "\"spar\""), {"ambient medium", "birefringent"},
              {"place it as a part"});
}

TEST_CASE("A medium without an index at the wavelengths in use is reported where it is named") {
  std::string scene =
      replaced(boxes(at("0", "2") + kPolished, at("4", "6") + kPolished), "\"420 nm\"", "\"600 nm\"");
  scene.erase(scene.find("@@"), 2);
  scene.insert(scene.find("\"thin\""), "@@");
  check_scene(scene, {"medium \"thin\"", "refractive indices", "400 to 500 nm", "600 nm"},
              {"index table", "other wavelengths"});
}

TEST_CASE(
    "Bonded parts may keep a surface for each direction, and parts without a surface have the other's") {
  const std::string rough = "surface = \"roncali2013_unified_rough\"\n";
  const auto between = [](std::string scene) {
    scene.erase(scene.find("@@"), 2);
    const BuiltScene built = SceneBuilder().build(
        SceneFile::from_text("contacts_default = \"each_side\"\n" + scene, "scene.toml").spec(0));
    for (const Interface& i : built.scene.interfaces)
      if (i.back != kAmbientRegion && i.front != kAmbientRegion)
        return std::pair(i.back_surface.has_value() ? built.scene.surfaces[i.back_surface].definition : "",
                         i.front_surface.has_value() ? built.scene.surfaces[i.front_surface].definition : "");
    return std::pair<std::string, std::string>();
  };
  using Pair = std::pair<std::string, std::string>;
  const Pair different = between(boxes(at("0", "2") + kPolished, at("2", "4") + rough));
  CHECK(different.first != different.second);
  CHECK(between(boxes(at("0", "2"), at("2", "4") + rough)) ==
        Pair("roncali2013_unified_rough", "roncali2013_unified_rough"));
  CHECK(between(boxes(at("0", "2"), at("2", "4") + kPolished)) == Pair("polished", ""));  // plain: once
  const std::string contact = "[[contact]]\nbetween = [\"a\", \"b\"]\nkind = \"each_side\"\n";
  CHECK(between(boxes(at("0", "2"), at("2", "4"),
                      contact + "leaving_second = \"roncali2013_unified_rough\"\n")) ==
        Pair("", "roncali2013_unified_rough"));
}

TEST_CASE("Surfaces of one direction belong to a contact for each side, and that has no other") {
  const auto with_contact = [](const std::string& keys) {
    std::string scene = boxes(at("0", "2") + kPolished, at("2", "4") + kPolished,
                              "[[contact]]\nbetween = [\"a\", \"b\"]\n" + keys);
    scene.erase(scene.find("@@"), 2);
    return scene;
  };
  check_scene(with_contact("kind = \"bonded\"\nleaving_first = @@\"polished\"\n"), "for one direction",
              "kind = \"each_side\"");
  check_scene(with_contact("kind = \"each_side\"\nsurface = @@\"polished\"\n"), "surface for each direction",
              "leaving_first");
}
