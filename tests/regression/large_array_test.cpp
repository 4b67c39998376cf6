/// What the largest arrays in use share. How long they take to build is printed by tools/bench.

#include <doctest/doctest.h>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"

using namespace scintray;
using namespace scintray::scene_file;
using namespace scintray::scene;

TEST_CASE("40 x 40 crystals on 40 x 40 sensors share one accelerator per surroundings") {
  const SceneFile file = SceneFile::from_text(R"(
ambient = "air"
[[array]]
name = "crystal"
count = [40, 40]
pitch = "1.6 mm"
[array.element]
box = ["1.5 mm", "1.5 mm", "20 mm"]
medium = "LSO"
surface = "polished"
[[array]]
name = "sensor"
count = [40, 40]
pitch = "1.6 mm"
place = { touch = "crystal", side = "-z", gap = "0.05 mm", fill = "optical_grease" }
[array.element]
box = ["1.4 mm", "1.4 mm", "0.3 mm"]
sensor = "S13360_6050VE"
[source]
type = "photons"
region = { part = "crystal[20,20]" }
wavelength = "420 nm"
photons = 1
)",
                                              "scene.toml");
  SceneBuilder builder;
  const BuiltScene built = builder.build(file.spec(0));
  CHECK(built.scene.parts.size() == 3201);
  CHECK(built.scene.accelerators.size() < 30);
}
