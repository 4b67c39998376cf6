#include "scintray/contact/neighbours.hpp"

#include "doctor/doctor_scenes.hpp"

using namespace scintray;
using namespace scintray::contact;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

std::vector<SmallGap> gaps(const std::string& gap) {
  const std::string text = lit_scene(part_text("crystal", "box = [\"2 mm\", \"2 mm\", \"20 mm\"]\n", "lso") +
                                         part_text("plate",
                                                   "box = [\"8 mm\", \"8 mm\", \"1 mm\"]\n"
                                                   "place = { touch = \"crystal\", side = \"+z\", gap = \"" +
                                                       gap + "\" }\n",
                                                   "n15"),
                                     "crystal", 10);
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
