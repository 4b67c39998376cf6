// Mistakes in scene files: what is stated, where, and how to correct it.
#include <algorithm>

#include "bad_input/good_scene.hpp"
#include "bad_input/marked_text.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

std::vector<Problem> problems_in(const std::string& text) {
  return problems_of([&] { SceneFile::from_text(text, "scene.toml"); });
}

/// Puts one mistake, with its place marked by @@, into the good scene.
void check_mistake(const std::string& old, const std::string& by, const Fragments& what,
                   const Fragments& hint) {
  const MarkedText input(replaced(kGoodScene, old, by));
  check_one_problem(input, problems_in(input.text), what, hint);
}

}  // namespace

TEST_CASE("the good scene is good") { CHECK(problems_in(kGoodScene).empty()); }

TEST_CASE("unknown keys name the nearest known one") {
  check_mistake("wavelength = \"420 nm\"", "wavelength = \"420 nm\"\n@@polarization = \"random\"",
                {"unknown key", "\"polarization\"", "[source]"}, "did you mean \"polarisation\"?");
  check_mistake("seed = 7", "seed = 7\n  @@\"max interactions\" = 5", "unknown key \"max interactions\"",
                "did you mean \"max_interactions\"?");
  check_mistake("gap = \"0.1 mm\"", "gap = \"0.1 mm\", @@gasp=1", {"unknown key", "\"gasp\"", "[part.place]"},
                "did you mean \"gap\"?");
  check_mistake("[run]", "@@[qqqqqqqq]\nx = 1\n[run]", {"unknown key", "\"qqqqqqqq\"", "top of the file"},
                {"known keys", "ambient, analysis, array, bench, claim, contact,"});
  check_mistake("face = \"crystal:exit\"", "face = \"crystal:exit\"\n@@bims.x = 3\n", "unknown key \"bims\"",
                "did you mean \"bins\"?");
}

TEST_CASE("keys without meaning beside the others are refused") {
  check_mistake("medium = \"LSO\"", "medium = \"LSO\"\n@@unit = \"mm\"", {"\"unit\"", "[part]", "no meaning"},
                "remove");
  check_mistake("wavelength = \"420 nm\"",
                "wavelength = \"420 nm\"\ndirection = { lambertian = [0, 0, 1], @@half_angle = \"3 deg\" }",
                {"\"half_angle\"", "[source.direction]", "no meaning"}, "remove");
}

TEST_CASE("missing keys are reported at their table") {
  check_mistake("title = \"Two parts\"\nambient = \"air\"\n", "@@title = \"Two parts\"\n",
                {"the file", "no \"ambient\""}, "add ambient");
  check_mistake("[source]\ntype = \"photons\"\n", "@@[source]\n", "[source] has no \"type\"", "add type");
  check_mistake("[[part]]\nname = \"crystal\"\nbox = [\"2 mm\", \"2 mm\", \"20 mm\"]\nmedium = \"LSO\"",
                "@@[[part]]\nname = \"crystal\"\nbox = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "[part] has no \"medium\"", "add medium");
  check_mistake("select = { normal = [0, 0, -1] }", "select = @@{ }", "empty selection",
                "part's own surface");
}

TEST_CASE("wrong types are reported with what was found and what is expected") {
  check_mistake("photons = 1000", "photons = @@\"many\"",
                {"\"source.photons\"", "string \"many\"", "an integer"}, "whole number");
  check_mistake("photons = 1000", "photons = @@1e3", {"number 1e3", "an integer"}, "without quotes");
  check_mistake("seed = 7", "seed = 7\npaths = @@-1", "0 to 100000", "number of photons");
  check_mistake("seed = 7", "seed = 7\nphoton_list = @@\"yes\"", "true or false", "without quotes");
  check_mistake("title = \"Two parts\"", "title = @@12", {"\"title\"", "integer 12", "a string"}, "quotes");
  check_mistake("[run]\nseed = 7", "@@[[run]]\nseed = 7", {"\"run\"", "list of tables"}, "once");
}

TEST_CASE("units are checked where they stand") {
  check_mistake("gap = \"0.1 mm\"", "gap = @@0.1", {"\"part.place.gap\"", "number 0.1", "length", "unit"},
                "\"0.1 mm\"");
  check_mistake("gap = \"0.1 mm\"", "gap = @@\"0.1 kg\"", {"\"kg\"", "not a unit", "length"}, "mm");
  check_mistake("gap = \"0.1 mm\"", "gap = @@\"0.1\"", "has no unit", "mm");
  check_mistake("gap = \"0.1 mm\"", "gap = @@\"wide\"", "finite number", "unit of length");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]", "box = [\"2 mm\", @@2, \"20 mm\"]",
                {"\"part.box\"", "integer 2"}, "\"2 mm\"");
  check_mistake("wavelength = \"420 nm\"", "wavelength = @@\"420 mm\"", {"not a unit", "wavelength"}, "nm");
  check_mistake("seed = 7", "max_time = @@\"5 mm\"", {"not a unit", "time"}, "ns");
  check_mistake("normal = [0, 0, -1]", "normal = [0, 0, -1], tolerance = @@2", {"angle", "unit"},
                "\"2 deg\"");
}

TEST_CASE("values outside their range") {
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]", "box = @@[\"2 mm\", \"0 mm\", \"20 mm\"]",
                "not positive", "above 0");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]", "box = @@[\"2 mm\", \"2 mm\"]",
                {"2 elements", "array of 3"}, "exactly 3");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "box = { low = [\"0 mm\", \"0 mm\", \"0 mm\"], high = @@[\"1 mm\", \"0 mm\", \"1 mm\"] }",
                "not above", "larger");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "cylinder = { radius = \"1 mm\", height = \"2 mm\", segments = @@2 }", "2 segments",
                "3 or more");
  // More triangles than any memory would hold, or than rounding leaves.
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "cylinder = { radius = \"1 mm\", height = \"2 mm\", segments = @@1000000 }",
                "1000000 segments", "10000");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "sphere = { radius = \"1 mm\", subdivisions = @@1000 }", "1000 subdivisions", {"1", "250"});
  check_mistake(
      "box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
      "winston = { exit_radius = \"1 mm\", acceptance = \"30 deg\", segments = 10000, rings = @@1000 }",
      {"10000 segments", "1000 rings", "20000000 triangles"}, "250000");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "cone = { bottom_radius = \"1 mm\", top_radius = @@\"-1 mm\", height = \"2 mm\" }",
                "negative", "0 mm");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
                "cone = { bottom_radius = \"0 mm\", top_radius = @@\"0 mm\", height = \"2 mm\" }",
                "both radii", "above 0");
  check_mistake("normal = [0, 0, -1]", "normal = @@[0, 0, 0]", "no length", "[0, 0, 1]");
  check_mistake("photons = 1000", "photons = @@0", "at least 1", "positive");
  check_mistake("seed = 7", "seed = @@-1", "seed below 0", "0 to");
  check_mistake("gap = \"0.1 mm\"", "gap = @@\"-0.1 mm\"", "overlap", "0 or more");
  check_mistake("gap = \"0.1 mm\", fill = \"grease\"", "fill = @@\"grease\"", "needs a gap", "add gap");
  check_mistake("slab_z = [\"1 mm\", \"3 mm\"]", "slab_z = @@[\"3 mm\", \"3 mm\"]", {"slab", "at or below"},
                "lower z first");
  check_mistake("face = \"crystal:exit\"", "face = \"crystal:exit\"\nbins = @@0", "number of bins", "90 deg");
}

TEST_CASE("mistakes in run.until") {
  const auto check = [](const std::string& until, const Fragments& what, const Fragments& hint) {
    check_mistake("seed = 7", "until = { " + until + " }", what, hint);
  };
  check_mistake("seed = 7", "until = @@{ }", "no condition", {"relative_error", "wall_time", "photons"});
  check_mistake("seed = 7", "until = @@{ fate = \"escaped\" }", "no condition", "relative_error");
  check("relative_error = @@1", {"above 0", "below 1"}, "\"1 %\"");
  check("relative_error = @@\"0 %\"", {"above 0", "below 1"}, "\"1 %\"");
  check("absolute_error = @@-0.1", {"above 0", "below 1"}, "\"1 %\"");
  check("absolute_error = @@\"1 mm\"", "\"mm\"", "%");
  check("wall_time = @@\"0 s\"", "not positive", "3600 s");
  check("wall_time = @@3600", {"integer 3600", "unit"}, "\"3600 ");
  check("photons = @@0", "at least 1", "positive");
  check("photons = @@1e5", "an integer", "without");
  check("fate = @@\"detcted\", photons = 5", "one of \"detected\"", "did you mean \"detected\"?");
  check("@@errror = 3, photons = 5", "unknown key", "known keys");
  check("of = @@\"ctrr\", photons = 5", "one of \"fate\"", "did you mean \"ctr\"?");
  check("of = @@\"fate\", photons = 5", "no error of it", "relative_error");
  check("of = @@\"ctr\", absolute_error = \"3 ps\"", {"result of events", "emits photons"}, "event source");
  check("of = @@\"photopeak\", relative_error = 0.1", {"result of events", "emits photons"}, "event source");
  check("of = \"tally\", tally = @@\"exits\", relative_error = 0.1", {"tally", "\"exits\""}, "crystal:exit");
  check("of = \"tally\", tally = \"crystal:exit\", bin = @@3, relative_error = 0.1", {"no list", "axis"},
        "a value within it");
  check_mistake("seed = 7", "until = @@{ of = \"tally\", relative_error = 0.1 }", "no \"tally\"",
                "add tally");
  check("relative_error = 0.1, @@bin = [3]", {"\"bin\"", "no meaning"}, "remove");
}

TEST_CASE("words outside their choice name the nearest") {
  check_mistake("kind = \"bonded\"", "kind = @@\"bondd\"", "one of \"bonded\", \"dry\"",
                "did you mean \"bonded\"?");
  check_mistake("side = \"-z\"", "side = @@\"z\"", "\"-x\", \"+x\"", "did you mean");
  check_mistake("type = \"photons\"", "type = @@\"gamma_event\"",
                {"\"photons\"", "\"gamma_events\"", "\"gammas\"", "\"hits\""},
                "did you mean \"gamma_events\"?");
  check_mistake("type = \"exit_angle\"", "type = @@\"angle\"", "one of \"exit_angle\", \"count\"", "words");
  check_mistake("wavelength = \"420 nm\"", "wavelength = \"420 nm\"\ndirection = @@\"up\"", "not a direction",
                "[0, 0, 1]");
}

TEST_CASE("names must refer to something, and be unique") {
  check_mistake("part = \"crystal\", slab_z", "part = @@\"cristal\", slab_z", {"no part", "\"cristal\""},
                "did you mean \"crystal\"?");
  check_mistake("touch = \"crystal\"", "touch = @@\"pmt\"", "does not stand before", "earlier");
  const std::string third =
      "box = [\"1 mm\", \"1 mm\", \"1 mm\"]\nmedium = \"LSO\"\nsurface = \"lso_polished\"\n";
  check_mistake("[[contact]]", "[[part]]\nname = @@\"crystal\"\n" + third + "[[contact]]",
                {"\"crystal\"", "already taken", "part"}, "name of its own");
  check_mistake("[[contact]]", "[[part]]\nname = @@\"pmt_fill\"\n" + third + "[[contact]]",
                {"\"pmt_fill\"", "already taken", "part"}, "name of its own");
  check_mistake("between = [\"pmt_fill\", \"pmt\"]", "between = @@[\"pmt_fill\", \"pmd\"]", "no part \"pmd\"",
                "did you mean \"pmt\"?");
  check_mistake("between = [\"pmt_fill\", \"pmt\"]", "between = @@[\"pmt\", \"pmt\"]", "with itself",
                "two parts");
  check_mistake("face = \"crystal:exit\"", "face = @@\"crystal:exits\"", "has no face \"exits\"",
                "did you mean \"exit\"?");
  check_mistake("face = \"crystal:exit\"", "face = @@\"crystal\"", {"not the name", "face"}, "part:face");
  check_mistake(
      "[[part]]\nname = \"pmt\"",
      "[[part.face]]\nname = @@\"other\"\nselect = { normal = [1, 0, 0] }\n[[part]]\nname = \"pmt\"",
      "already taken", "no rule matches");
  check_mistake("[[contact]]", "[[part]]\nname = @@\"crys.tal\"\n" + third + "[[contact]]", "contains a dot",
                "letters");
  check_mistake("[media.grease]", "@@[media.opaque]\nindex = { n = 1.5 }\n[media.grease]",
                "cannot be defined", "another name");
}

TEST_CASE("one shape, one origin") {
  check_mistake("medium = \"LSO\"", "medium = \"LSO\"\n@@cylinder = { radius = \"1 mm\" }", "both given",
                "keep one");
  check_mistake("region = { part = \"crystal\", slab_z = [\"1 mm\", \"3 mm\"] }",
                "region = { part = \"crystal\", slab_z = [\"1 mm\", \"3 mm\"] }\n@@position = [\"0 mm\", \"0 "
                "mm\", \"0 mm\"]",
                "both given", "keep one");
  check_mistake("[[part]]\nname = \"crystal\"\nbox = [\"2 mm\", \"2 mm\", \"20 mm\"]\n",
                "@@[[part]]\nname = \"crystal\"\n", {"none of", "\"mesh\"", "\"box\"", "\"cylinder\""},
                "add one");
}

TEST_CASE("mesh files must exist and have a unit") {
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]", "mesh = @@\"no_such.stl\"\nunit = \"mm\"",
                "\"no_such.stl\" does not exist", "relative path");
  const std::string mesh = source_file("LICENSE").string();
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]", "mesh = \"" + mesh + "\"\nunit = @@\"furlong\"",
                {"\"furlong\"", "not a unit", "length"}, "mm");
  check_mistake("box = [\"2 mm\", \"2 mm\", \"20 mm\"]", "mesh = @@\"" + mesh + "\"", {"not", "which unit"},
                "unit = \"mm\"");
}

TEST_CASE("sweeps that lead nowhere") {
  const std::string key = "key = \"source.region.slab_z.center\"\nvalues = [\"2 mm\", \"6 mm\"]";
  check_mistake(key, "key = @@\"sourc.photons\"\nvalues = [1]", {"scene", "no \"sourc\""},
                "did you mean \"source\"?");
  check_mistake(key, "key = @@\"part.cristal.surface\"\nvalues = [\"a\"]", "\"part\" has no \"cristal\"",
                "did you mean \"crystal\"?");
  check_mistake(key, "key = @@\"part.crystal\"\nvalues = [\"a\"]", "names a whole table",
                "part.crystal.surface");
  check_mistake(key, "key = @@\"source.photns\"\nvalues = [1, 2]", "unknown key \"photns\"",
                "did you mean \"photons\"?");
  check_mistake(key, "key = @@\"run.threads\"\nvalues = [1]", "cannot be swept", "scene file");
  check_mistake(key, "key = @@\"source.photons.\"\nvalues = [1]", "leads nowhere", "");
  check_mistake(key, "key = \"source.photons\"\nvalues = @@[]", "one value or more", "values = [");
  check_mistake(key, "key = \"source.wavelength\"\nvalues = [\"420 nm\", @@\"430 mm\"]",
                {"not a unit", "wavelength"}, "nm");
  check_mistake(key, "key = \"source.region.slab_z.center\"\nvalues = [\"2 mm\", @@6]", "6 has no unit",
                "\"2 mm\"");
  check_mistake("[media.grease]",
                "[[sweep]]\nkey = @@\"source.region.slab_z.center\"\nvalues = [\"1 mm\"]\n[media.grease]",
                "swept twice", "one [[sweep]]");
}

TEST_CASE("all problems come at once, each with its place") {
  std::string text = kGoodScene;
  text = replaced(text, "medium = \"LSO\"", "medum = \"LSO\"");
  text = replaced(text, "gap = \"0.1 mm\"", "gap = 0.1");
  text = replaced(text, "photons = 1000", "photons = \"many\"");
  text = replaced(text, "seed = 7", "seed = -7");
  text = replaced(text, "face = \"crystal:exit\"", "face = \"crystal:exits\"");
  const std::vector<Problem> found = problems_in(text);
  std::vector<std::string> places;
  for (const Problem& problem : found) places.push_back(problem.where.text());
  const std::vector<std::string> expected{
      "scene.toml:4:1",    // no medium
      "scene.toml:7:1",    // medum
      "scene.toml:17:49",  // gap
      "scene.toml:28:11",  // photons
      "scene.toml:31:8",   // seed
      "scene.toml:35:8",   // face
  };
  for (const std::string& place : expected) {
    INFO(place);
    CHECK(std::count(places.begin(), places.end(), place) == 1);
  }
  CHECK(found.size() == expected.size());
}

TEST_CASE("a mistake outside the sweep is reported once, not once a point") {
  const auto found = problems_in(replaced(kGoodScene, "photons = 1000", "photons = 0"));
  CHECK(found.size() == 1);
}
