// Arrays: positions of elements, septa, glue, fillers and wraps, and their contacts.
#include <doctest/doctest.h>

#include "bad_input/marked_text.hpp"
#include "scene/builder_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

const std::string kBlock = R"(
[[array]]
name = "block"
count = [3, 2]
pitch = "2.1 mm"
[array.element]
box = ["2 mm", "2 mm", "10 mm"]
medium = "crystal"
surface = "flat"
)";

doctest::Approx exactly(double value) { return doctest::Approx(value).epsilon(1e-9); }

void check_bounds(const PartInfo& part, const Vec3& low, const Vec3& high) {
  CAPTURE(part.name);
  CHECK(part.bounds.min().isApprox(low, 1e-9));
  CHECK(part.bounds.max().isApprox(high, 1e-9));
}

}  // namespace

TEST_CASE("An array is centred on x = y = 0, stands on z = 0, and counts columns along x") {
  const auto parts = parts_by_name(built(scene_with(kBlock, "block[0,1]")).scene);
  CHECK(parts.size() == 6);
  check_bounds(parts.at("block[0,0]"), Vec3(-3.1, -2.05, 0), Vec3(-1.1, -0.05, 10));
  check_bounds(parts.at("block[2,1]"), Vec3(1.1, 0.05, 0), Vec3(3.1, 2.05, 10));
}

TEST_CASE("A gap is a pitch less the element, and may differ along x and y") {
  const std::string text = replaced(kBlock, "pitch = \"2.1 mm\"", "gap = [\"0.1 mm\", \"0 mm\"]");
  const Scene scene = built(scene_with(text, "block[0,1]")).scene;
  const auto parts = parts_by_name(scene);
  check_bounds(parts.at("block[2,1]"), Vec3(1.1, 0, 0), Vec3(3.1, 2, 10));
  CHECK(between(scene, "block[1,0]", "block[1,1]").area_mm2 == exactly(20.0));
  CHECK(between(scene, "block[0,0]", "block[1,0]").area_mm2 == 0.0);
}

TEST_CASE("Identical elements share one accelerator") {
  const std::string text = replaced(kBlock, "count = [3, 2]", "count = [8, 8]");
  const Scene scene = built(scene_with(text, "block[0,1]")).scene;
  CHECK(scene.parts.size() == 64);
  CHECK(scene.accelerators.size() == 2);  // the elements', and that of the space around them
}

TEST_CASE("An array turns, touches and moves as one body, and is touched as one") {
  const std::string text = R"(
[[part]]
name = "plate"
box = ["20 mm", "20 mm", "1 mm"]
medium = "glue"
surface = "flat"
)" + kBlock + R"(
[[part]]
name = "lid"
box = ["1 mm", "1 mm", "1 mm"]
place = { touch = "block", side = "+z", gap = "0.5 mm", fill = "glue" }
medium = "glue"
surface = "flat"
)";
  const std::string placed = replaced(text, "pitch = \"2.1 mm\"", R"(pitch = "2.1 mm"
rotate = { axis = [0, 0, 1], angle = "90 deg" }
place = { touch = "plate", side = "+z", gap = "0.2 mm", fill = "glue" }
translate = ["1 mm", "0 mm", "0 mm"])");
  const Scene scene = built(scene_with(placed, "block[0,1]")).scene;
  const auto parts = parts_by_name(scene);
  // (x, y) became (-y, x), then + 1 mm along x.
  check_bounds(parts.at("block[0,0]"), Vec3(1.05, -3.1, 1.2), Vec3(3.05, -1.1, 11.2));
  check_bounds(parts.at("block_fill"), Vec3(-1.05, -3.1, 1.0), Vec3(3.05, 3.1, 1.2));
  check_bounds(parts.at("lid"), Vec3(0.5, -0.5, 11.7), Vec3(1.5, 0.5, 12.7));
  CHECK(parts.count("lid_fill") == 1);
  CHECK(between(scene, "block[2,1]", "block_fill").area_mm2 == exactly(4.0));
}

TEST_CASE("Face rules of an element count in its own frame, so every element has the same faces") {
  const std::string text =
      replaced(kBlock, "pitch = \"2.1 mm\"",
               "pitch = \"2.1 mm\"\nrotate = { axis = [1, 0, 0], angle = \"180 deg\" }") +
      R"(
[[array.element.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "ground"
[[array.element.face]]
name = "corner"
select = { nearest = ["1 mm", "0.5 mm", "5 mm"] }
surface = "ground"
)";
  const Scene scene = built(scene_with(text, "block[0,1]")).scene;
  const auto faces = faces_by_name(scene);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i) {
      const std::string name = "block[" + std::to_string(i) + "," + std::to_string(j) + "]";
      CHECK(faces.at(name + ":exit").area_mm2 == exactly(4.0));
      CHECK(faces.at(name + ":corner").triangles == 1);
    }
}

TEST_CASE("Septa stand in the middle of the gaps, in pieces that do not cross, of the height that is set") {
  const std::string text = kBlock + R"(
[array.septa]
reflector = "white"
thickness = "0.06 mm"
height = ["3 mm", "10 mm"]
)";
  const Scene scene = built(scene_with(text, "block[0,1]")).scene;
  const auto parts = parts_by_name(scene);
  CHECK(parts.size() == 6 + 1 + 2 * 2);
  check_bounds(parts.at("block_septum_y[0]"), Vec3(-3.1, -0.03, 3), Vec3(3.1, 0.03, 10));
  check_bounds(parts.at("block_septum_x[1,0]"), Vec3(1.02, -2.05, 3), Vec3(1.08, -0.03, 10));
  check_bounds(parts.at("block_septum_x[1,1]"), Vec3(1.02, 0.03, 3), Vec3(1.08, 2.05, 10));
  CHECK(scene.media[scene.regions[parts.at("block_septum_y[0]").region].medium].is_opaque());
  CHECK(faces_by_name(scene).at("block_septum_y[0]:other").surface == "sheet of white");

  const auto only_x = parts_by_name(
      built(scene_with(replaced(text, "height = [\"3 mm\", \"10 mm\"]", "y = false"), "block[0,1]")).scene);
  CHECK(only_x.size() == 6 + 2);
  check_bounds(only_x.at("block_septum_x[0]"), Vec3(-1.08, -2.05, 0), Vec3(-1.02, 2.05, 10));
}

TEST_CASE("Septa as thick as the gap touch the crystals, dry unless set otherwise") {
  for (const bool bonded : {false, true}) {
    const Scene scene = built(scene_with(kBlock + R"(
[array.septa]
reflector = "white"
thickness = "0.1 mm"
contact = ")" + (bonded ? "bonded" : "dry") + "\"\n",
                                         "block[0,1]"))
                            .scene;
    const Between contact = between(scene, "block[0,0]", "block_septum_y[0]");
    CHECK(contact.area_mm2 == exactly(20.0));
    CHECK(contact.interface.gap_medium.has_value() != bonded);
    const SurfaceId back = contact.interface.back_surface, front = contact.interface.front_surface;
    CHECK(scene.surfaces[bonded && back.has_value() ? back : front].name.rfind("sheet of white", 0) == 0);
  }
}

TEST_CASE("A filler is bonded to elements and septa, also where contacts are dry by default") {
  const Scene scene = built(scene_with(replaced(kBlock, "pitch", "filler = \"glue\"\npitch") + R"(
[array.septa]
reflector = "white"
thickness = "0.06 mm"
height = ["3 mm", "10 mm"]
)",
                                       "block[0,1]", "dry"))
                          .scene;
  const auto parts = parts_by_name(scene);
  check_bounds(parts.at("block_filler"), Vec3(-3.1, -2.05, 0), Vec3(3.1, 2.05, 10));
  const Between glued = between(scene, "block[1,0]", "block_filler");
  CHECK(glued.area_mm2 == exactly(3.0 * 20.0));  // its fourth side is flush with the block's
  CHECK(!glued.interface.gap_medium.has_value());
  const Between wet = between(scene, "block_septum_y[0]", "block_filler");
  CHECK(!wet.interface.gap_medium.has_value());
  CHECK(scene.regions[parts.at("block_filler").region].medium != scene.regions[kAmbientRegion].medium);
}

TEST_CASE("Layers stand on each other with their own counts, offsets and glue") {
  const Scene scene = built(scene_with(R"(
[[array]]
name = "doi"
count = [4, 4]
pitch = "2 mm"
glue = { medium = "glue", thickness = "0.1 mm" }
[array.element]
box = ["2 mm", "2 mm", "6 mm"]
medium = "crystal"
surface = "flat"
[[array.layer]]
[[array.layer]]
count = [3, 3]
offset = [0.25, 0]
height = "4 mm"
surface = "ground"
[[array.layer]]
count = [1, 1]
offset = ["0 mm", "1 mm"]
element = { cylinder = { radius = "1 mm", height = "2 mm" }, medium = "glue", surface = "flat" }
)",
                                       "doi[0,0,0]"))
                          .scene;
  const auto parts = parts_by_name(scene);
  CHECK(parts.size() == 16 + 9 + 1 + 2);
  check_bounds(parts.at("doi[0,0,0]"), Vec3(-4, -4, 0), Vec3(-2, -2, 6));
  check_bounds(parts.at("doi[1,0,0]"), Vec3(-2.5, -3, 6.1), Vec3(-0.5, -1, 10.1));
  check_bounds(parts.at("doi_glue[0]"), Vec3(-2.5, -3, 6), Vec3(3.5, 3, 6.1));
  check_bounds(parts.at("doi_glue[1]"), Vec3(-1, 0, 10.1), Vec3(1, 2, 10.2));
  CHECK(parts.at("doi[2,0,0]").bounds.min().z() == exactly(10.2));
  CHECK(faces_by_name(scene).at("doi[1,1,1]:other").surface == "ground");
  CHECK(between(scene, "doi[1,1,1]", "doi_glue[0]").area_mm2 == exactly(4.0));
}

TEST_CASE("Shifted rows pack hexagons without gaps") {
  const Scene scene = built(scene_with(R"(
[[array]]
name = "hex"
count = [4, 3]
pitch = ["2 mm", "1.7320508075688772 mm"]
row_shift = 0.5
[array.element]
prism = { sides = 6, flat_to_flat = "2 mm", height = "10 mm" }
rotate = { axis = [0, 0, 1], angle = "30 deg" }
medium = "crystal"
surface = "flat"
)",
                                       "hex[0,1]", "dry"))
                          .scene;
  const double side = 2.0 / std::sqrt(3.0);
  CHECK(between(scene, "hex[1,1]", "hex[2,1]").area_mm2 == doctest::Approx(10.0 * side).epsilon(1e-6));
  CHECK(between(scene, "hex[1,1]", "hex[1,0]").area_mm2 + between(scene, "hex[1,1]", "hex[2,0]").area_mm2 ==
        doctest::Approx(20.0 * side).epsilon(1e-6));
  const auto parts = parts_by_name(scene);
  CHECK(parts.at("hex[0,1]").bounds.center().x() - parts.at("hex[0,0]").bounds.center().x() == exactly(1.0));
}

TEST_CASE("Overrides choose elements by column, row, layer, border and colour of a chess board") {
  const Scene scene = built(scene_with(R"(
[[array]]
name = "block"
count = [4, 3]
pitch = "2.1 mm"
[array.element]
box = ["2 mm", "2 mm", "10 mm"]
medium = "crystal"
surface = "flat"
[[array.override]]
select = { columns = [0] }
[[array.override.face]]
name = "outer"
select = { normal = [-1, 0, 0] }
surface = "ground"
[[array.override]]
select = { checker = "even" }
surface = "ground"
[[array.override]]
select = { border = true, rows = [2] }
medium = "glue"
[[array.override]]
select = { columns = [1], rows = [1] }
remove = true
)",
                                       "block[0,0]"))
                          .scene;
  const auto parts = parts_by_name(scene);
  const auto faces = faces_by_name(scene);
  CHECK(parts.size() == 11);
  CHECK(parts.count("block[1,1]") == 0);
  CHECK(faces.at("block[0,1]:outer").surface == "ground");
  CHECK(faces.at("block[0,1]:other").surface == "flat");
  CHECK(faces.at("block[0,0]:other").surface == "ground");
  CHECK(faces.count("block[1,0]:outer") == 0);
  const auto medium = [&](const std::string& part) {
    return scene.media[scene.regions[parts.at(part).region].medium].medium().name;
  };
  CHECK(medium("block[3,2]") == "glue");
  CHECK(medium("block[3,1]") == "crystal");
}

TEST_CASE("A wrap lies around the whole block, its sheets corner to corner") {
  const Scene scene = built(scene_with(kBlock + R"(
[array.wrap]
reflector = "white"
thickness = "0.1 mm"
gap = "0.05 mm"
sides = ["-x", "+x", "-y", "+z"]
)",
                                       "block[0,1]"))
                          .scene;
  const auto parts = parts_by_name(scene);
  CHECK(parts.size() == 6 + 4);
  check_bounds(parts.at("block_wrap[-x]"), Vec3(-3.25, -2.1, 0), Vec3(-3.15, 2.05, 10.05));
  check_bounds(parts.at("block_wrap[-y]"), Vec3(-3.25, -2.2, 0), Vec3(3.25, -2.1, 10.05));
  check_bounds(parts.at("block_wrap[+z]"), Vec3(-3.25, -2.2, 10.05), Vec3(3.25, 2.05, 10.15));
}

TEST_CASE("Contacts take patterns, and the one that spells out most of the names holds") {
  const std::string touching = replaced(kBlock, "2.1 mm", "2 mm") + R"(
[[contact]]
between = ["block[*]", "block[*]"]
kind = "dry"
[[contact]]
between = ["block[1,*]", "block[1,*]"]
kind = "bonded"
surface = "ground"
)";
  const Scene scene = built(scene_with(touching, "block[0,1]")).scene;
  CHECK(between(scene, "block[0,0]", "block[1,0]").interface.gap_medium.has_value());
  CHECK(between(scene, "block[0,0]", "block[0,1]").interface.gap_medium.has_value());
  CHECK(!between(scene, "block[1,0]", "block[1,1]").interface.gap_medium.has_value());
}

TEST_CASE("A sweep goes over the elements that a pattern matches") {
  const SceneFile file = SceneFile::from_text(scene_with(kBlock, "block[0,1]") + R"(
[[sweep]]
key = "source.region.part"
values = ["block[*,1]", "block[0,0]"]
[[sweep]]
key = "array.block.element.surface"
values = ["flat", "ground"]
)",
                                              "scene.toml");
  CHECK(file.points() == 8);
  CHECK(file.parameters(2)[0] == "block[1,1]");
  CHECK(file.parameters(6)[0] == "block[0,0]");
  CHECK(file.spec(7).parts[3].surface.name == "ground");
}
