#include "doctor/doctor_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::test;

// A light guide over an 8 x 8 array.

namespace {

/// 64 crystals of 2 x 2 x 10 mm, 0.1 mm apart, under one guide of 16.8 x 16.8 x 3 mm with a sensor on top.
/// With one piece the guide's lower face has nothing in common with the crystals' faces; with 64 each
/// crystal has its own piece of guide of the same cross-section, so that all meshes conform, and the
/// pieces touch each other and strips between them.
std::string array(bool conforming) {
  std::string scene = "ambient = \"vacuum_n1\"\n";
  const auto box = [&](const std::string& name, const char* medium, double x0, double x1, double y0,
                       double y1, double z0, double z1) {
    scene += part_text(name, corners({x0, y0, z0}, {x1, y1, z1}), medium);
  };
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      box(fmt::format("crystal{}", 8 * i + j), "lso", 2.1 * i, 2.1 * i + 2.0, 2.1 * j, 2.1 * j + 2.0, 0.0,
          10.0);
  if (!conforming) {
    box("guide", "n15", 0.0, 16.8, 0.0, 16.8, 10.0, 13.0);
  } else {
    // Over each crystal a piece of its own size, and strips of 0.1 mm over the gaps: faces match exactly.
    for (int i = 0; i < 16; ++i)
      for (int j = 0; j < 16; ++j) {
        const auto low = [](int k) { return 2.1 * (k / 2) + (k % 2 == 0 ? 0.0 : 2.0); };
        const auto high = [](int k) { return 2.1 * (k / 2) + (k % 2 == 0 ? 2.0 : 2.1); };
        box(fmt::format("guide{}", 16 * i + j), "n15", low(i), high(i), low(j), high(j), 10.0, 13.0);
      }
  }
  return scene + R"(
[[part]]
name = "sensor"
box = { low = ["0 mm", "0 mm", "13 mm"], high = ["16.8 mm", "16.8 mm", "14 mm"] }
sensor = "perfect"
[source]
type = "photons"
region = { part = "crystal27" }
wavelength = "420 nm"
photons = 15_000
[run]
seed = )" +
         (conforming ? "2" : "1") + "\n";
}

}  // namespace

TEST_CASE(
    "A light guide over 64 crystals: the light is the same with one unequal mesh and with conforming ones") {
  const Traced whole = trace(array(false)), pieces = trace(array(true));
  std::size_t interfaces = 0;
  double area = 0.0;
  const Scene& scene = whole.built.scene;
  for (const InterfaceId i : scene.interfaces.ids()) {
    const Interface& interface = scene.interfaces[i];
    const std::string &back = scene.region_names[interface.back],
                      &front = scene.region_names[interface.front];
    if ((back == "guide") == (front == "guide")) continue;
    if (back.rfind("crystal", 0) != 0 && front.rfind("crystal", 0) != 0) continue;
    ++interfaces;
    area += scene.interface_area_mm2[i];
  }
  CHECK(interfaces == 64);
  CHECK(area == doctest::Approx(256.0).epsilon(1e-9));
  // 4 sigma for each of four numbers: a false alarm in about 4,000 runs with other seeds.
  for (const Fate fate : {Fate::detected, Fate::absorbed_in_medium, Fate::escaped}) {
    CAPTURE(fate_name(fate));
    CHECK(sigmas(whole.result.fraction(fate), pieces.result.fraction(fate)) < kSigmas);
  }
  CHECK(sigmas(whole.result.detected_path_mm.mean(), pieces.result.detected_path_mm.mean()) < kSigmas);
}
