// Mistakes in builders and shapes: what is stated, where, and how to correct it.
#include "bad_input/marked_text.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

const std::string kScene = R"(ambient = "air"

[[array]]
name = "block"
count = [4, 4]
pitch = "2.1 mm"
[array.element]
box = ["2 mm", "2 mm", "10 mm"]
medium = "LSO"
surface = "polished"
[array.septa]
reflector = "ESR"
thickness = "0.065 mm"
height = ["2 mm", "10 mm"]
[[array.layer]]
[[array.layer]]
height = "12 mm"
[[array.override]]
select = { columns = [0], checker = "even" }
surface = "roncali2013_unified_rough"

[[light_guide]]
name = "guide"
bottom = "9 mm"
top = "8.3 mm"
height = "4 mm"
medium = "glass"
surface = "polished"
place = { touch = "block", side = "-z" }
[light_guide.slits]
segments = [4, 4]
depth = "3 mm"
width = "0.2 mm"

[[part]]
name = "bar"
prism = { sides = 6, flat_to_flat = "2 mm", height = "20 mm" }
translate = ["30 mm", "0 mm", "0 mm"]
medium = "glass"
surface = "polished"

[[part]]
name = "cone"
winston = { exit_radius = "1 mm", acceptance = "30 deg" }
translate = ["50 mm", "0 mm", "0 mm"]
medium = "glass"
surface = "polished"

[[contact]]
between = ["block[0,*]", "guide*"]
kind = "dry"

[source]
type = "photons"
region = { part = "block[0,1,2]" }
wavelength = "420 nm"
photons = 1000
)";

void check_builder_mistake(const std::string& old, const std::string& by, const Fragments& what,
                           const Fragments& hint) {
  const MarkedText input(replaced(kScene, old, by));
  const auto found = problems_of([&] { SceneFile::from_text(input.text, "scene.toml"); });
  check_one_problem(input, found, what, hint);
}

std::vector<Problem> problems_when_built(const std::string& text) {
  return problems_of([&] {
    SceneBuilder builder;
    builder.build(SceneFile::from_text(text, "scene.toml").spec(0));
  });
}

}  // namespace

TEST_CASE("the scene of builders is good") {
  CHECK(problems_of([] { SceneFile::from_text(kScene, "scene.toml"); }).empty());
}

TEST_CASE("counts and distances of arrays") {
  check_builder_mistake("count = [4, 4]", "count = @@[4, 0]", {"not whole", "1 to 10000"}, "along x and y");
  check_builder_mistake("count = [4, 4]", "count = @@[4.5, 4]", "not whole", "count = [12, 12]");
  check_builder_mistake("count = [4, 4]", "count = @@[9999, 9999]", "more than 200000 elements", "fewer");
  check_builder_mistake("pitch = \"2.1 mm\"\n", "pitch = \"2.1 mm\"\n@@gap = \"0.1 mm\"\n",
                        {"\"array.gap\"", "\"pitch\"", "both given"}, "keep one");
  check_builder_mistake("height = \"12 mm\"",
                        "element = { box = [\"2 mm\", \"2 mm\", \"12 mm\"], medium = \"LSO\", "
                        "surface = \"polished\" }\npitch = @@[\"2.1 mm\", \"1.9 mm\"]",
                        {"pitch of 1.9 mm", "along y", "2 mm"}, "touch");
}

TEST_CASE("septa that do not fit") {
  check_builder_mistake("thickness = \"0.065 mm\"", "thickness = @@\"0.2 mm\"",
                        {"septa of 0.2 mm", "gap of 0.1 mm", "along x"}, "thinner");
  check_builder_mistake("thickness = \"0.065 mm\"", "thickness = @@\"0 mm\"", "not positive", "above 0");
  check_builder_mistake("height = [\"2 mm\", \"10 mm\"]", "height = @@[\"2 mm\", \"11 mm\"]",
                        {"septa from 2 mm to 11 mm", "10 mm high"}, "bottom of the elements");
  check_builder_mistake("reflector = \"ESR\"\n", "@@reflector = \"ESR\"\nsurface = \"polished\"\n",
                        "both given", "keep one");
  check_builder_mistake("reflector = \"ESR\"\n",
                        "reflector = \"ESR\"\nmedium = \"glass\"\ncontact = @@\"glued\"\n",
                        "one of \"dry\", \"bonded\"", "words");
}

TEST_CASE("an opaque medium between the faces of septa that transmit light") {
  const std::string leaking =
      replaced(kScene, "reflector = \"ESR\"\n", "reflector = \"thin\"\nmedium = @@\"opaque\"\n") +
      "[reflectors.thin]\nreflectance = { value = 0.9 }\ntransmittance = { value = 0.08 "
      "}\ndirection = { specular_share = 0 }\n";
  const MarkedText input(leaking);
  check_one_problem(input, problems_when_built(input.text), {"light", "faces", "sheet \"block_septum_"},
                    "as medium = \"air\"");
  const std::string clear = replaced(input.text, "medium = \"opaque\"\n", "medium = \"air\"\n");
  CHECK(problems_when_built(clear).empty());
}

TEST_CASE("overrides of elements that are not there") {
  check_builder_mistake("columns = [0]", "columns = @@[4]", "only 4 columns", "from 0");
  check_builder_mistake("columns = [0]", "layers = @@[2]", "only 2 layers", "from 0");
  check_builder_mistake("columns = [0]", "columns = @@[-1]", "below 0", "count from 0");
  check_builder_mistake("checker = \"even\"", "checker = @@\"white\"", "\"even\", \"odd\"", "words");
}

TEST_CASE("light guides") {
  check_builder_mistake("depth = \"3 mm\"", "depth = @@\"5 mm\"", "deeper than the guide",
                        "up to the height");
  check_builder_mistake("width = \"0.2 mm\"", "width = @@\"2.5 mm\"", {"wide", "segment"}, "2.075");
  check_builder_mistake("bottom = \"9 mm\"", "bottom = @@\"-9 mm\"", "not positive", "above 0");
}

TEST_CASE("shapes") {
  check_builder_mistake("sides = 6", "sides = @@2", {"prism", "2 sides"}, "3 or more");
  check_builder_mistake("sides = 6, flat_to_flat = ", "sides = 5, flat_to_flat = @@", "no flats opposite",
                        "radius");
  check_builder_mistake("height = \"20 mm\" }", "height = \"20 mm\" }\nchamfer = @@\"0.7 mm\"",
                        "shortest edge", "half of the shortest");
  check_builder_mistake("acceptance = \"30 deg\" }", "acceptance = \"30 deg\" }\n@@chamfer = \"0.1 mm\"",
                        {"\"chamfer\"", "[part]", "no meaning"}, "remove");
  check_builder_mistake("acceptance = \"30 deg\"", "acceptance = @@\"95 deg\"", {"outside", "0 to 90 deg"},
                        "taken in");
  check_builder_mistake("acceptance = \"30 deg\"", "entrance_radius = @@\"0.9 mm\"", "not wider", "above");
  check_builder_mistake("acceptance = \"30 deg\"", "acceptance = \"30 deg\", length = @@\"9 mm\"", "5.19",
                        "leave it out");
}

TEST_CASE("names of builders' parts, and patterns") {
  check_builder_mistake("name = \"bar\"", "name = @@\"guide[0,0]\"", "already taken", "name of its own");
  check_builder_mistake("name = \"bar\"", "name = @@\"bar*\"", "a star", "patterns");
  check_builder_mistake("[\"block[0,*]\", \"guide*\"]", "@@[\"blocks[0,*]\", \"guide*\"]", "no part matches",
                        "any characters");
  check_builder_mistake("part = \"block[0,1,2]\"", "part = @@\"block[0,1,4]\"",
                        {"no part", "\"block[0,1,4]\""}, "did you mean \"block[0,1,");
  check_builder_mistake("part = \"block[0,1,2]\"", "part = @@\"block[9*\"", "no part matches", "in all)");
}

TEST_CASE("a mistake in every element is reported once") {
  const auto found = problems_when_built(replaced(
      kScene, "[array.septa]",
      "[[array.element.face]]\nselect = { normal = [1, 1, 0] }\nsurface = \"polished\"\n[array.septa]"));
  REQUIRE(found.size() >= 1);
  check_contains(found[0].what, {"matches no face", "\"block[0,0,0]\""});
  std::size_t times = 0;
  for (const Problem& problem : found) times += contains(problem.what, "matches no face");
  CHECK(times == 1);
}

TEST_CASE("contacts that match a pair equally well and differ are named") {
  const auto found = problems_when_built(replaced(kScene, "[source]", R"([[contact]]
between = ["block[0,*", "guide[*"]
kind = "bonded"
surface = "polished"
[source])"));
  REQUIRE(found.size() == 1);
  CHECK(contains(found[0].what, "equally close"));
}
