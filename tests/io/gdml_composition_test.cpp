// What GDML materials consist of, and curves that are constant.
#include <doctest/doctest.h>

#include "io/gdml_texts.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::exchange;
using namespace scintray::test;

namespace {

SceneDraft draft_with(const std::string& materials, const std::string& material) {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.materials = materials;
  text.structure = gdml_volume("body", "it", material);
  gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  return gdml::draft_of_gdml(text.text(), "test.gdml", options);
}

constexpr const char* kElements =
    R"(<element name="Hydrogen" formula="H" Z="1"><atom value="1.008"/></element>
<element name="Oxygen" formula="O" Z="8"><atom value="15.999"/></element>
<isotope name="Lu175" Z="71" N="175"><atom value="174.94"/></isotope>
<isotope name="Lu176" Z="71" N="176"><atom value="175.94"/></isotope>
<element name="Lutetium"><fraction n="0.974" ref="Lu175"/><fraction n="0.026" ref="Lu176"/></element>
)";

}  // namespace

TEST_CASE("GDML: numbers of atoms, mass fractions, mixtures and isotopes become mass fractions") {
  const std::string elements = kElements;
  const std::string water = elements +
                            R"(<material name="Water"><property name="RINDEX" ref="N15"/><D value="1"/>
<composite n="2" ref="Hydrogen"/><composite n="1" ref="Oxygen"/></material>
)";
  // 2 x 1.008 of 18.015.
  check_contains(draft_with(water, "Water").toml, {"mass_fractions", "H = 0.111906", "O = 0.888093"});
  const std::string wet = water + R"(<material name="Wet"><property name="RINDEX" ref="N15"/><D value="2"/>
<fraction n="0.5" ref="Water"/><fraction n="0.5" ref="Oxygen"/></material>
)";
  check_contains(draft_with(wet, "Wet").toml, {"mass_fractions", "H = 0.055953", "O = 0.944046"});
  const std::string oxide =
      elements + R"(<material name="Lutetia"><property name="RINDEX" ref="N15"/><D value="9.4"/>
<composite n="2" ref="Lutetium"/><composite n="3" ref="Oxygen"/></material>
)";
  // 2 x 174.966 and 3 x 15.999 of 397.929.
  check_contains(draft_with(oxide, "Lutetia").toml, {"Lu = 0.87938", "O = 0.12061"});
}

TEST_CASE("GDML: a composition that is not complete is listed as left out") {
  const std::string broken = R"(<material name="Odd"><property name="RINDEX" ref="N15"/><D value="1"/>
<fraction n="1" ref="Nowhere"/></material>
)";
  const SceneDraft scene = draft_with(broken, "Odd");
  CHECK_FALSE(contains(scene.toml, "mass_fractions"));
  std::string notes;
  for (const std::string& note : scene.notes) notes += note + "\n";
  check_contains(notes, {"Odd", "composition"});
}

TEST_CASE("GDML: a constant index stays one pair of values") {
  const std::string toml = draft_with("", "Glass").toml;
  const std::size_t vacuum = toml.find("[media.\"Vacuum\"]");
  REQUIRE(vacuum != std::string::npos);
  const std::size_t index = toml.find("value = [", vacuum);
  check_contains(toml.substr(index, toml.find(']', index) + 1 - index), "value = [1, 1]");
}
