// Mistakes in what is stated of events: [analysis], [[claim]], the light of a medium, numbers of events.
#include <doctest/doctest.h>

#include "bad_input/good_scene.hpp"
#include "bad_input/marked_text.hpp"
#include "scintray/materials/material_forms.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::materials;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

std::string said_of_scene(const std::string& more) {
  return complaint_of([&] { SceneFile::from_text(std::string(kGoodScene) + more, "scene.toml"); });
}

std::string said_of_medium(const std::string& more) {
  return complaint_of([&] {
    Problems problems;
    const TomlTable table(parse_toml("index = { n = 1.8 }\nabsorption = { none = true }\n"
                                     "scattering = { none = true }\n" +
                                         more,
                                     "medium.toml"),
                          problems);
    read_medium(table, "crystal", SourceRule::optional);
    table.finish();
    problems.throw_if_any();
  });
}

const std::string kLight = R"(
[yield]
value = "25 1/keV"
[emission]
spectrum = { wavelength = [400, 440], wavelength_unit = "nm", value = [1, 1] }
[[decay]]
time = "40 ns"
rise = "0 ns"
fraction = 1.0
)";

}  // namespace

TEST_CASE("mistakes in [analysis] have their place and a hint") {
  check_contains(said_of_scene("[analysis]\nphotopeak = [900, 500]\n"), {"two numbers", "lower first"});
  check_contains(said_of_scene("[analysis]\ndepth = { from = [\"0 mm\", \"0 mm\", \"0 mm\"] }\n"),
                 {"depth", "needs", "direction"});
  check_contains(said_of_scene("[analysis]\nslices = 1\n"), {"not in", "2 to 1000"});
  check_contains(said_of_scene("[analysis]\nanger_threshold = \"120 %\"\n"), "0 to below 1");
  check_contains(said_of_scene("[analysis]\npeeks = 3\n"), "did you mean \"peaks\"?");
  check_contains(said_of_scene("[analysis]\n[[analysis.layer]]\nparts = [\"crystal\"]\n"), "one layer");
}

TEST_CASE("mistakes in [[claim]] have their place and a hint") {
  const std::string start = "[[claim]]\ntext = \"t\"\ncurve = \"a\"\n";
  check_contains(said_of_scene(start + "quantity = \"fall\"\n"), {"claim", "without bounds"});
  check_contains(said_of_scene(start + "quantity = \"fall_difference\"\nat_least = 0.1\n"),
                 "compares two curves");
  check_contains(said_of_scene(start + "quantity = \"fall\"\nover = \"b\"\nat_least = 0.1\n"),
                 "is of one curve");
  check_contains(said_of_scene(start + "quantity = \"fal\"\nat_least = 0.1\n"), "did you mean \"fall\"?");
}

TEST_CASE("mistakes in the light of a medium have their place and a hint") {
  CHECK(said_of_medium(kLight).empty());
  check_contains(said_of_medium(kLight + "[non_proportionality]\nresponse = 1.0\n"), "one value");
  check_contains(
      said_of_medium(kLight + "[non_proportionality]\nresponse = { energy = [10, 100], energy_unit = "
                              "\"keV\", value = [-0.1, 1] }\n"),
      {"above 0", "up to 10"});
  check_contains(said_of_medium(kLight + "[intrinsic_resolution]\nfwhm = \"120 %\"\nenergy = \"662 keV\"\n"),
                 "0 to below 1");
  check_contains(said_of_medium(kLight + "[intrinsic_resolution]\nfwhm = \"8 %\"\nenergy = \"0 keV\"\n"),
                 {"energy", "positive"});
  check_contains(said_of_medium("[intrinsic_resolution]\nfwhm = \"8 %\"\nenergy = \"662 keV\"\n"),
                 {"medium", "not scintillate"});
}

TEST_CASE("absolute errors of until are in the unit of their result") {
  const auto said = [](const std::string& until) {
    std::string scene = kGoodScene;
    const std::string photons =
        "type = \"photons\"\nregion = { part = \"crystal\", slab_z = [\"1 mm\", \"3 mm\"] }\n"
        "wavelength = \"420 nm\"\nphotons = 1000";
    scene = replaced(scene, photons,
                     "type = \"gamma_events\"\nevents = 5\nenergy = \"8 keV\"\n"
                     "region = { part = \"crystal\", slab_z = [\"1 mm\", \"3 mm\"] }");
    return complaint_of([&] {
      SceneFile::from_text(replaced(scene, "seed = 7", "until = { " + until + " }"), "scene.toml");
    });
  };
  check_contains(said("of = \"ctr\", absolute_error = \"1 %\""), {"absolute_error", "time"});
  check_contains(said("of = \"ctr\", absolute_error = \"0 ps\""), "above 0");
  check_contains(said("of = \"ctr\", absolute_error = \"0 ps\""), "\"2 ps\"");
  check_contains(said("of = \"photopeak\", absolute_error = \"3 keV\""), "keV");
  check_contains(said("of = \"photopeak\", absolute_error = 0"), "above 0");
  check_contains(said("of = \"photopeak\", absolute_error = 0"), "in photons");
  check_contains(said("of = \"light_per_energy\", absolute_error = 0.1"), "unit");
  check_contains(said("of = \"energy_resolution\", absolute_error = 2"), "below 1");
  CHECK(said("of = \"ctr\", absolute_error = \"2 ps\", wall_time = \"10 s\", events = 4") == "");
}
