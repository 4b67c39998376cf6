// [fit] of scene files: what is read, and what is stated of mistakes.
#include <doctest/doctest.h>

#include <fstream>

#include "bad_input/good_scene.hpp"
#include "bad_input/marked_text.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::config;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

const std::string kFitTable = R"(
[surfaces.ground]
model = "unified"
unified = { sigma_alpha = "12 deg", definition = "solid_angle", facets = "geant4", lobe = 1.0 }
[surfaces.wrapped]
mixture = [{ surface = "ground", share = 0.5 }, { surface = "polished" }]
[fit]
measurement = "light.csv"
quantity = "detected_fraction"
at = "source.region.slab_z.center"
unit = "mm"
scale = "free"
[[fit.parameter]]
key = "surfaces.ground.unified.sigma_alpha"
label = "facets"
start = "8 deg"
low = "2 deg"
high = "40 deg"
[[fit.parameter]]
key = "surfaces.wrapped.mixture.ground.share"
start = 0.4
low = 0
high = 1
)";

const std::string kGoniometer = R"([fit.goniometer]
surface = "ground"
inside = "LSO"
outside = "air"
wavelength = "420 nm"
side = "inside"
)";

SceneFile fit_file(const std::string& fit) {
  const auto folder = scratch_folder("fit_spec");
  std::ofstream(folder / "light.csv") << "2,310,5\n6,280,4\n";
  return SceneFile::from_text(kGoodScene + fit, (folder / "scene.toml").string());
}

void check_fit_problem(const std::string& marked, const Fragments& what, const Fragments& hint) {
  const MarkedText input(kGoodScene + marked);
  const std::string fit = input.text.substr(std::string(kGoodScene).size());
  check_one_problem(input, problems_of([&] { fit_file(fit); }), what, hint);
}

}  // namespace

TEST_CASE("[fit] is read, with units as they are written") {
  const SceneSpec scene = fit_file(kFitTable).spec(0);
  REQUIRE(scene.fit);
  const FitSpec& fit = *scene.fit;
  CHECK(fit.measurement.filename() == "light.csv");
  CHECK(fit.quantity == FitQuantity::detected_fraction);
  CHECK(fit.at.key == "source.region.slab_z.center");
  CHECK(fit.unit == "mm");
  CHECK(fit.free_scale);
  CHECK_FALSE(fit.errors_from_scatter);
  CHECK_FALSE(fit.goniometer);
  REQUIRE(fit.parameters.size() == 2);
  CHECK(fit.parameters[0].label == "facets");
  CHECK(fit.parameters[0].unit == "deg");
  CHECK(fit.parameters[0].start == 8.0);
  CHECK(fit.parameters[0].high == 40.0);
  CHECK(fit.parameters[1].label == "surfaces.wrapped.mixture.ground.share");
  CHECK(fit.parameters[1].unit.empty());

  const FitSpec reflectance =
      *fit_file(replaced(replaced(replaced(kFitTable, "\"detected_fraction\"", "\"reflectance\""),
                                  "at = \"source.region.slab_z.center\"\n", ""),
                         "unit = \"mm\"", "unit = \"deg\"") +
                kGoniometer)
           .spec(0)
           .fit;
  REQUIRE(reflectance.goniometer);
  CHECK(reflectance.goniometer->surface.name == "ground");
  CHECK(reflectance.goniometer->wavelength_nm == 420.0);
  CHECK(reflectance.goniometer->from_inside);
  CHECK(reflectance.goniometer->rays == 100000);
}

TEST_CASE(
    "Lengths of absorption and scattering are fitted by their inverse, all else as it is, unless stated") {
  const auto variable = [](const std::string& key, const std::string& low, const std::string& more) {
    const std::string parameter = "\n[[fit.parameter]]\nkey = \"" + key + "\"\nstart = \"50 mm\"\nlow = \"" +
                                  low + "\"\nhigh = \"90 mm\"\n" + more;
    return fit_file(kFitTable + parameter +
                    "\n[media.crystal]\nindex = { n = 1.82 }\nabsorption = { length = \"60 mm\" }\n"
                    "scattering = { length = \"256 mm\", kind = \"rayleigh\" }\n")
        .spec(0)
        .fit->parameters.back()
        .variable;
  };
  CHECK(variable("media.crystal.absorption.length", "2 mm", "") == FitVariable::inverse);
  CHECK(variable("media.crystal.scattering.length", "2 mm", "") == FitVariable::inverse);
  CHECK(variable("media.crystal.absorption.length", "2 mm", "variable = \"value\"\n") == FitVariable::value);
  const FitSpec fit = *fit_file(kFitTable).spec(0).fit;
  CHECK(fit.parameters[0].variable == FitVariable::value);
  check_fit_problem(
      replaced(kFitTable, "start = 0.4\nlow = 0", "start = 0.4\nvariable = @@\"inverse\"\nlow = 0"),
      {"the inverse of surfaces.wrapped.mixture.ground.share", "\"low\" is 0"}, "variable = \"value\"");
}

TEST_CASE("Fitted keys and positions take their values in the scene, over those of sweeps") {
  const SceneFile file = fit_file(kFitTable);
  const FitSpec fit = *file.spec(0).fit;
  const SceneSpec scene = file.spec(1, {fit.parameters[0].setting(15.25), fit.parameters[1].setting(0.125),
                                        fit.position(9.0, {"light.csv", 2, 0})});
  const TomlNode& ground = *scene.surfaces.at("ground");
  CHECK(ground.find("unified")->find("sigma_alpha")->text == "15.25 deg");
  const TomlNode& mixture = *scene.surfaces.at("wrapped")->find("mixture");
  CHECK(mixture.items[0].find("share")->number == 0.125);
  const auto& region = std::get<RegionSpec>(scene.source.origin);
  CHECK((*region.slab_z_mm)[0] == doctest::Approx(8.0));
  CHECK((*region.slab_z_mm)[1] == doctest::Approx(10.0));
}

TEST_CASE("Mistakes in [fit] are named with their place and how to mend them") {
  const auto with = [](const std::string& old, const std::string& by) {
    return replaced(kFitTable, old, by);
  };
  check_fit_problem(with("\"light.csv\"", "@@\"dark.csv\""), "dark.csv", "");
  check_fit_problem(with("\"detected_fraction\"", "@@\"brightness\""), "brightness", "in quotes");
  check_fit_problem(with("scale = \"free\"", "scale = @@\"loose\""), "loose", "in quotes");
  check_fit_problem(with("start = \"8 deg\"", "start = @@\"1 deg\""),
                    {"not lie between", "low, 2", "high, 40"}, "start within the bounds");
  check_fit_problem(with("low = \"2 deg\"", "low = @@\"0.03 rad\""),
                    {"\"low\"", "\"rad\"", "\"start\"", "\"deg\""}, "in one unit");
  check_fit_problem(with("high = \"40 deg\"", "high = @@true"), {"not a number", "unit"}, "as \"12 deg\"");
  check_fit_problem(
      with("\"surfaces.ground.unified.sigma_alpha\"", "@@\"surfaces.ground.unify.sigma_alpha\""),
      {"\"surfaces.ground.unify.sigma_alpha\"", "leads nowhere"}, "model, unified");
  check_fit_problem(
      with("\"surfaces.wrapped.mixture.ground.share\"", "@@\"surfaces.wrapped.mixture.grund.share\""),
      "has no \"grund\"", "did you mean \"ground\"");
  check_fit_problem(with("\"surfaces.wrapped.mixture.ground.share\"", "@@\"fit.unit\""), "cannot be set here",
                    "key of the scene");
  check_fit_problem(
      with("\"surfaces.wrapped.mixture.ground.share\"", "@@\"surfaces.ground.unified.sigma_alpha\""),
      "is fitted twice", "one [[fit.parameter]]");
  const auto complaint = [&](const std::string& fit) { return complaint_of([&] { fit_file(fit); }); };
  check_contains(complaint(with("at = \"source.region.slab_z.center\"\n", "")),
                 {"[fit]", "no \"at\"", "detected_fraction"});
  const std::string reflectance = complaint(with("\"detected_fraction\"", "\"reflectance\""));
  check_contains(reflectance, {"\"at\"", "reflectance"});
  check_contains(reflectance, "[fit] has no \"goniometer\"");
  check_contains(reflectance, {"not a unit", "angle"});
  check_contains(complaint(with("scale = \"free\"\n", "")), "scale");
  check_contains(complaint(kFitTable.substr(0, kFitTable.find("[[fit.parameter]]"))), "nothing to find");
  check_contains(complaint(with("unit = \"mm\"\n", "unit = \"mm\"\nsacle = 1\n")), "sacle");
}

TEST_CASE("A value that a scene refuses at the bounds of a fit is found when the scene is read") {
  const std::string text = complaint_of([] {
    fit_file(replaced(kFitTable, "key = \"surfaces.wrapped.mixture.ground.share\"\nstart = 0.4\nlow = 0",
                      "key = \"source.photons\"\nstart = 0.4\nlow = -1"));
  });
  check_contains(text, "photons");
}
