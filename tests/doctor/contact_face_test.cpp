#include "doctor/doctor_scenes.hpp"

using namespace scintray;
using namespace scintray::scene;
using namespace scintray::test;

// One pair of parts that touches at several faces, each with its own contact.

namespace {

/// A crystal in the corner of an L made of one mesh is a pair that touches on two faces: here a block with
/// a step, cut by priority, so that the crystal touches it from below and from the side.
std::string in_a_corner(const std::string& contacts) {
  const std::string rules =
      "priority = 1\n[[part.face]]\nselect = { normal = [-1, 0, 0] }\n"
      "[[part.face]]\nselect = { normal = [0, 0, -1] }\n";
  return lit_scene(part_text("corner", corners({0, 0, 0}, {4, 4, 4}), "n15") +
                       part_text("crystal", corners({2, 0, 2}, {6, 4, 6}), "lso") + rules + contacts,
                   "crystal", 3000);
}

const Interface* between(const Scene& scene, const std::string& face) {
  for (const Interface& interface : scene.interfaces)
    for (const core::FaceId id : {interface.back_face, interface.front_face})
      if (interface.back_face.has_value() && interface.front_face.has_value() && scene.faces[id].name == face)
        return &interface;
  return nullptr;
}

}  // namespace

TEST_CASE("Dry on one face and bonded on the next face of the same pair") {
  const Traced traced = trace(in_a_corner(R"(
[[contact]]
between = ["crystal:-x", "corner"]
kind = "dry"
[[contact]]
between = ["corner", "crystal:-z"]
kind = "bonded"
)"));
  const Interface *side = between(traced.built.scene, "crystal:-x"),
                  *below = between(traced.built.scene, "crystal:-z");
  REQUIRE(side != nullptr);
  REQUIRE(below != nullptr);
  CHECK(side->gap_medium.has_value());
  CHECK(!below->gap_medium.has_value());
}

TEST_CASE("A contact of one face comes before that of the whole part") {
  const Scene scene = SceneBuilder()
                          .build(scene_spec(in_a_corner(R"(
[[contact]]
between = ["crystal", "corner"]
kind = "dry"
[[contact]]
between = ["crystal:-z", "corner:cut:crystal"]
kind = "bonded"
)")))
                          .scene;
  CHECK(between(scene, "crystal:-x")->gap_medium.has_value());
  CHECK(!between(scene, "crystal:-z")->gap_medium.has_value());
}

TEST_CASE("A contact names a side of a box that no rule makes a face") {
  const std::string parts = part_text("below", corners({0, 0, 0}, {4, 4, 2}), "n15") +
                            part_text("above", corners({0, 0, 2}, {4, 4, 4}), "lso");
  const Scene scene =
      SceneBuilder()
          .build(scene_spec(lit_scene(
              parts + "[[contact]]\nbetween = [\"below:+z\", \"above\"]\nkind = \"dry\"\n", "above", 10)))
          .scene;
  const Interface* interface = between(scene, "below:+z");
  REQUIRE(interface != nullptr);
  CHECK(interface->gap_medium.has_value());
  CHECK(between(scene, "below:other") == nullptr);
}

TEST_CASE("A contact of one part comes before that of many parts by a pattern") {
  std::string parts = part_text("guide", corners({0, 0, 4}, {9, 4, 5}), "n15");
  for (int i = 0; i < 3; ++i)
    parts += part_text(fmt::format("crystal[{}]", i), corners({3.0 * i, 0, 0}, {3.0 * i + 2.0, 4, 4}), "lso");
  const Scene scene =
      SceneBuilder()
          .build(scene_spec(lit_scene(
              parts + "[[contact]]\nbetween = [\"crystal[*]:other\", \"guide\"]\nkind = \"dry\"\n"
                      "[[contact]]\nbetween = [\"guide:other\", \"crystal[1]:other\"]\nkind = \"bonded\"\n",
              "guide", 10)))
          .scene;
  for (int i = 0; i < 3; ++i) {
    const Interface* interface = between(scene, fmt::format("crystal[{}]:other", i));
    REQUIRE(interface != nullptr);
    CHECK(interface->gap_medium.has_value() == (i != 1));
  }
}

TEST_CASE("Contacts that contradict, name no face, or match nothing are refused with the reason") {
  CHECK(
      refusal(in_a_corner("[[contact]]\nbetween = [\"crystal:-z\", \"corner\"]\nkind = \"dry\"\n[[contact]]\n"
                          "between = [\"crystal\", \"corner:cut:crystal\"]\nkind = \"bonded\"\n"))
          .find("are equally close to") != std::string::npos);
  CHECK(refusal(in_a_corner("[[contact]]\nbetween = [\"crystal:-w\", \"corner\"]\nkind = \"dry\"\n"))
            .find("the part \"crystal\" has no face \"-w\"\n  hint: did you mean") != std::string::npos);
  CHECK(refusal(in_a_corner("[[contact]]\nbetween = [\"crystal:-y\", \"corner\"]\nkind = \"dry\"\n"))
            .find("\"crystal:-y\" and \"corner\" of this contact do not touch") != std::string::npos);
  CHECK(refusal(in_a_corner("[[contact]]\nbetween = [\"crystal:other\", \"corner\"]\nkind = \"dry\"\n"))
            .find("\"crystal:other\" and \"corner\" of this contact do not touch") != std::string::npos);
}
