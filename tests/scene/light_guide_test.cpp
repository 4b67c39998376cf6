// Segmented light guides: their pieces, the joint that is no surface, and what stands in the slits.
#include <doctest/doctest.h>

#include "bad_input/marked_text.hpp"
#include "scene/builder_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

const std::string kGuide = R"(
[[light_guide]]
name = "guide"
medium = "glue"
surface = "ground"
end_surface = "flat"
bottom = ["10 mm", "12 mm"]
top = "8 mm"
height = "6 mm"
[light_guide.slits]
segments = [2, 3]
depth = "4 mm"
width = "0.2 mm"
)";

doctest::Approx to_rounding(double value) { return doctest::Approx(value).epsilon(1e-9); }

/// Volume of the guide without slits: h / 6 (A0 + 4 Am + A1).
constexpr double kWhole = 6.0 / 6.0 * (120.0 + 4.0 * 9.0 * 10.0 + 64.0);

/// Area that the two directions of slits take at a height of relative width.
double slit_area(double z) {
  const double x = 10.0 - 2.0 * z / 6.0, y = 12.0 - 4.0 * z / 6.0;
  return 0.2 * y + 2.0 * 0.2 * x - 2.0 * 0.04;
}

}  // namespace

TEST_CASE("A light guide's pieces add up to the frustum less its slits") {
  const Scene scene = built(scene_with(kGuide, "guide_base")).scene;
  const auto parts = parts_by_name(scene);
  CHECK(parts.size() == 7);
  double volume = 0.0;
  for (const auto& [name, part] : parts) volume += part.volume_mm3;
  CHECK(volume == to_rounding(kWhole - 4.0 / 6.0 * (slit_area(2.0) + 4.0 * slit_area(4.0) + slit_area(6.0))));
  CHECK(parts.at("guide[0,0]").bounds.max().isApprox(Vec3(-0.1, -0.1 - 8.0 / 6.0 + 0.0, 6.0), 0.2));
  CHECK(parts.at("guide_base").bounds.max().isApprox(Vec3(5, 6, 2), 1e-9));
}

TEST_CASE("The joint between segments and base has no effect on light, whatever the guide's finish") {
  const Scene scene = built(scene_with(kGuide, "guide_base", "dry")).scene;
  const Between joint = between(scene, "guide_base", "guide[1,1]");
  CHECK(joint.area_mm2 > 10.0);
  CHECK(joint.interface.plain);
  CHECK(!joint.interface.gap_medium.has_value());
  const auto faces = faces_by_name(scene);
  CHECK(faces.at("guide_base:-z").surface == "flat");
  CHECK(faces.at("guide[1,1]:+z").surface == "flat");
  CHECK(faces.at("guide[1,1]:other").surface == "ground");
}

TEST_CASE("Slits from below, slits right through, and sheets in slits") {
  const Scene below =
      built(scene_with(replaced(kGuide, "depth =", "from = \"bottom\"\ndepth ="), "guide_base")).scene;
  CHECK(parts_by_name(below).at("guide_base").bounds.min().z() == to_rounding(4.0));
  CHECK(between(below, "guide_base", "guide[0,2]").interface.plain);

  const auto through = parts_by_name(built(scene_with(replaced(kGuide, "4 mm", "6 mm"), "guide[0,0]")).scene);
  CHECK(through.count("guide_base") == 0);
  CHECK(through.size() == 6);

  const Scene filled = built(scene_with(kGuide + "sheet = { reflector = \"white\" }\n", "guide_base")).scene;
  const auto parts = parts_by_name(filled);
  CHECK(parts.size() == 7 + 2 + 3);
  double volume = 0.0;
  for (const auto& [name, part] : parts) volume += part.volume_mm3;
  CHECK(volume == to_rounding(kWhole));
  const Between dry = between(filled, "guide[0,0]", "guide_slit_x[0,0]");
  CHECK(dry.area_mm2 > 1.0);
  CHECK(dry.interface.gap_medium.has_value());
}
