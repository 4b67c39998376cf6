/// How long the largest arrays in use take to build.

#include <doctest/doctest.h>

#include <chrono>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/read_scene.hpp"

using namespace scintray;

TEST_CASE(
    "40 x 40 crystals on 40 x 40 sensors are built in seconds, sharing one accelerator per surroundings") {
  const auto start = std::chrono::steady_clock::now();
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
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  MESSAGE("built in " << seconds << " s, " << built.scene.accelerators << " accelerators");
  CHECK(built.scene.parts.size() == 3201);
  CHECK(seconds < 20.0);  // about a second on one core of 2020; slow machines and others' load have the rest
  CHECK(built.scene.accelerators < 30);
}
