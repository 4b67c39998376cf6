#include "scintray/scene/small_gaps.hpp"

#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

std::vector<SmallGap> gaps(const std::string& gap) {
  const std::string text = R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "lso"
surface = "flat"
[[part]]
name = "plate"
box = ["8 mm", "8 mm", "1 mm"]
place = { touch = "crystal", side = "+z", gap = ")" +
                           gap + R"(" }
medium = "n15"
surface = "flat"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 10
)";
  return find_small_gaps(SceneBuilder().build(scene_spec(text)).placed, 1e-4);
}

}  // namespace

TEST_CASE("A gap above the contact tolerance and below a thousandth of the smaller part is found") {
  // The plate's diagonal is 11.36 mm, the crystal's 20.2 mm.
  const auto found = gaps("3 um");
  REQUIRE(found.size() == 1);
  CHECK(found[0].a == "crystal");
  CHECK(found[0].b == "plate");
  CHECK(found[0].gap_mm == doctest::Approx(3e-3));
  CHECK(found[0].place.z() == doctest::Approx(20.0015));
  CHECK(gaps("11 um").size() == 1);
  CHECK(gaps("12 um").empty());
  CHECK(gaps("0.05 um").empty());
}
