#include "cli/dark_crystal.hpp"
#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/h5.hpp"
#include "support/page_scripts.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

namespace {

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("A fit prints its steps and what it found, and writes a file and a page") {
  const DarkCrystal crystal("fit_program");
  const Ended ended = crystal.fit({"--seed", "3", "--threads", "2"});
  CAPTURE(ended.output);
  REQUIRE(ended.exit_code == cli::kSuccess);
  for (const char* words :
       {"start   chi-square", "step 1", "5 points, 1 parameter, a free scale, 1000 photons at each point",
        "seed 3", "absorption length", " 8 mm ", "2 to 50 mm", "chi-square", "degrees of freedom",
        "residual / error", "results  scene_fit.h5", "report   scene_fit.html"})
    CHECK(contains(ended.output, words));
  const h5::File file = h5::File::open(crystal.folder / "scene_fit.h5");
  const h5::Group root = file.root();
  CHECK(root.string_attribute("", "format") == "scintray-fit");
  CHECK(root.integer_attribute("", "complete") == 1);
  const h5::Group parameters = root.open_group("parameters");
  CHECK(parameters.read_strings("key") == std::vector<std::string>{"media.dark.absorption.length"});
  CHECK(parameters.read_strings("unit") == std::vector<std::string>{"mm"});
  CHECK(parameters.read<double>("value").at(0) > 2.0);
  CHECK(parameters.read<double>("error").at(0) > 0.0);
  CHECK(root.open_group("curve").read<double>("residual").size() == 5);
  for (const std::string& group : {std::string("parameters"), std::string("curve"), std::string("steps")})
    for (const std::string& name : root.open_group(group).members()) {
      CAPTURE(name);
      CHECK_FALSE(root.open_group(group).string_attribute(name, "description").empty());
    }
  std::ostringstream page;
  page << std::ifstream(crystal.folder / "scene_fit.html").rdbuf();
  for (const char* words : {"A dark crystal", "measured", "fitted", "Residuals", "absorption length"})
    CHECK(contains(page.str(), words));
  CHECK_FALSE(contains(scripts_of(page.str()).page, "nan"));

  const Ended again = crystal.fit({"--seed", "3", "--threads", "1", "--quiet"});
  CHECK_FALSE(contains(again.output, "step 1"));
  CHECK(
      h5::File::open(crystal.folder / "scene_fit.h5").root().open_group("parameters").read<double>("value") ==
      parameters.read<double>("value"));
}

TEST_CASE("What the curves of a fit do not include stands beside it, in its file, on its page and in JSON") {
  const DarkCrystal crystal("fit_omissions");
  const auto content = [&](const char* name) {
    std::ostringstream text;
    text << std::ifstream(crystal.folder / name).rdbuf();
    return text.str();
  };
  for (const bool ideal : {true, false}) {
    CAPTURE(ideal);
    const std::string scene =
        changed(kDarkCrystal, "\"ideal\"", ideal ? "\"ideal\"" : "\"R6231\"") + kDarkFit;
    std::ofstream(crystal.folder / "scene.toml") << scene;
    const Ended ended = crystal.fit({"--photons", "400", "--quiet", "--json", "--restart"});
    CAPTURE(ended.output);
    REQUIRE(ended.exit_code == cli::kSuccess);
    const h5::File file = h5::File::open(crystal.folder / "scene_fit.h5");
    const std::vector<std::string> effects = file.root().read_strings("not_included");
    CHECK(effects.empty() == ideal);
    const std::string effect = "reflection behind the sensor's window, back into the detector";
    CHECK(contains(ended.output, effect) != ideal);
    CHECK(contains(ended.output, "\"not_included\""));
    const std::string sentence = ideal
                                     ? "The detected fraction includes every effect that is modelled."
                                     : "The detected fraction does not include: reflection behind the sensor";
    CHECK(contains(content("scene_fit.html"), sentence));
    if (!ideal) CHECK(effects.front() == effect + " (R6231)");
  }
}

TEST_CASE("A measurement that cannot be fitted is refused with its place and what to do") {
  const DarkCrystal crystal("fit_refusals");
  crystal.write(kDarkFit, "5,190,7\n1,310,9\n3,240,-8\n");
  crystal.refuses({"light.csv:2: error:", "position of 1 after 5"}, "sort the rows");
  crystal.refuses({"light.csv:3: error:", "error of -8", "more than 0"}, "standard deviation");
  crystal.refuses("light.csv:3: error:", "the file is named at scene.toml:24:15");
  crystal.write(kDarkFit, "1,310,9\n");
  crystal.refuses({"1 measured points", "2 at least", "1 parameters", "scale"}, "fit fewer parameters");
  crystal.write(kDarkFit, "1,310\n3,240\n5,180\n");
  crystal.refuses("has no errors", "errors = \"from_scatter\"");
  crystal.write(changed(kDarkFit, "scale = ", "errors = \"from_scatter\"\nscale = "), kRows);
  crystal.refuses("column of errors", "remove errors");
  crystal.write(kDarkFit, changed(kRows, "9,120", "25,120"));
  crystal.refuses("measured position 25 mm (", {"light.csv:6)", "source region", "outside part"});
  std::filesystem::remove(crystal.folder / "light.csv");
  crystal.refuses("scene.toml:24:15", "light.csv");
}

TEST_CASE("A scene that leaves a fit open is refused") {
  const DarkCrystal crystal("fit_open");
  crystal.write("", kRows);
  crystal.refuses("no [fit]", "docs/fit.md");
  crystal.write(changed(kDarkFit, "detected_fraction", "light_per_keV"), kRows);
  crystal.refuses({"light_per_keV", "[source]", "photons"}, "detected_fraction");
  crystal.write("[[sweep]]\nkey = \"source.photons\"\nvalues = [100, 200]\n" + kDarkFit, kRows);
  crystal.refuses({"sweep", "\"source.photons\"", "has 2 values"}, "reduce it to one value");
  crystal.write(changed(kDarkFit, "low = \"2 mm\"", "low = \"-2 mm\""), kRows);
  crystal.refuses({"length", "positive"}, "");
  crystal.write(changed(kDarkFit, "media.dark.absorption.length", "media.dark.absorption.lenght"), kRows);
  crystal.refuses("lenght", "length");
  crystal.write(kDarkFit, kRows);
  crystal.refuses("--events is given", "use --photons", {"--events", "10"});
  std::ofstream(crystal.folder / "scene_fit.h5") << "mine";
  crystal.refuses({"not a fit", "not written over"}, "another name");
}

TEST_CASE("A fit that is interrupted keeps the best so far and is marked as partial") {
  const DarkCrystal crystal("fit_interrupted");
  const Program program({"fit", "scene.toml", "--photons", "3000000", "--threads", "1"}, crystal.folder);
  // The start is printed once its curve is traced.
  for (int i = 0; i < 600; ++i) {
    std::ostringstream text;
    text << std::ifstream(crystal.folder / "output.txt").rdbuf();
    if (contains(text.str(), "chi-square")) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  program.signal(SIGINT);
  const Ended ended = program.wait();
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kInterrupted);
  check_contains(ended.output, {"stopped by the user", "best so far"});
  const h5::File file = h5::File::open(crystal.folder / "scene_fit.h5");
  CHECK(file.root().integer_attribute("", "complete") == 0);
  CHECK(file.root().string_attribute("", "end") == "stopped");
}
