// [readout]: what is read, and what is stated of mistakes.
#include "scintray/scene_file/readout.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/detector/microcells.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::detector;
using namespace scintray::materials;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

const std::string kPlainReadout = R"(sampling = "2 GHz"
before = "20 ns"
window = "300 ns"
threshold = 2.5
)";

ReadoutSpec readout_of(const std::string& body) {
  Problems problems;
  const TomlTable root(parse_toml("[readout]\n" + body, "scene.toml"), problems);
  const std::optional<ReadoutSpec> readout = read_readout(root);
  root.finish();
  problems.throw_if_any();
  REQUIRE(readout.has_value());
  return *readout;
}

/// Everything that is stated of the plain readout with further lines.
std::string said_of(const std::string& more) {
  return complaint_of([&] { readout_of(kPlainReadout + more); });
}

/// The same with a line of it replaced.
std::string said_of(const std::string& old, const std::string& by) {
  std::string body = kPlainReadout;
  body.replace(body.find(old), old.size(), by);
  return complaint_of([&] { readout_of(body); });
}

}  // namespace

TEST_CASE("a readout without anything optional") {
  const ReadoutSpec readout = readout_of(kPlainReadout);
  CHECK(readout.period_ns == 0.5);
  CHECK(readout.samples() == 600);
  CHECK(readout.before_ns == 20.0);
  CHECK_FALSE(readout.gate_ns.has_value());
  CHECK(readout.shaping_ns.empty());
  CHECK(readout.noise == 0.0);
  CHECK(readout.adc_bits == 0);
  CHECK(readout.time_pickoff == TimePickoff::leading_edge);
  CHECK(readout.threshold == 2.5);
  CHECK_FALSE(readout.pulses);
  CHECK(readout.photon_order.empty());
  Problems none;
  CHECK_FALSE(read_readout(TomlTable(parse_toml("x = 1\n", "scene.toml"), none)).has_value());
}

TEST_CASE("shapers are series of stages") {
  CHECK(readout_of(kPlainReadout + "shaping = { order = 3, time_constant = \"5 ns\" }").shaping_ns ==
        std::vector<double>(4, 5.0));
  CHECK(readout_of(kPlainReadout + "shaping = { decay = \"50 ns\", rise = \"2 ns\" }").shaping_ns ==
        std::vector<double>{50.0, 2.0});
}

TEST_CASE("the documented readout and its sensor are read") {
  const std::string text = read_text_file(source_file("docs/readout.md"));
  const auto begin = text.find("```toml\n[readout]") + 8;
  const std::string example = text.substr(begin, text.find("```", begin) - begin);
  Problems problems;
  const TomlTable root(parse_toml(example, "scene.toml"), problems);
  const std::optional<ReadoutSpec> readout = read_readout(root);
  const TomlNodePtr sensors = root.take("sensors");
  root.finish();
  problems.throw_if_any();
  REQUIRE(readout.has_value());
  CHECK(readout->time_pickoff == TimePickoff::cfd);
  CHECK(readout->shaping_ns.size() == 3);
  CHECK(readout->photon_order == std::vector<std::uint64_t>{1, 5, 20});
  REQUIRE(sensors != nullptr);
  MaterialDatabase database({source_file("materials")});
  database.add(DefinitionKind::sensor,
               {{"my_sipm", std::make_shared<const TomlNode>(*sensors->find("my_sipm"))}});
  CHECK(database.sensor("my_sipm").avalanches.get_if<MicrocellModel>() != nullptr);
}

TEST_CASE("mistakes in a readout are reported with what was found and what is expected") {
  check_contains(said_of("sampling = \"2 GHz\"", "sampling = \"2 ns\""),
                 {"\"ns\"", "not a unit", "frequency"});
  check_contains(said_of("sampling = \"2 GHz\"", "sampling = \"0 GHz\""), "must be above 0");
  check_contains(said_of("sampling = \"2 GHz\"\n", ""), "sampling");
  check_contains(said_of("period = \"1 ns\"\n"), "period");
  check_contains(said_of("before = \"20 ns\"", "before = \"-20 ns\""), "cannot be negative");
  check_contains(said_of("window = \"300 ns\"", "window = \"300 s\""), "2 to 1000000 samples");
  check_contains(said_of("threshold = 2.5", "threshold = 0"), {"threshold", "above 0"});
  check_contains(said_of("gate = [\"10 ns\", \"5 ns\"]\n"), {"open", "closes"});
  check_contains(said_of("gate = [\"-30 ns\", \"5 ns\"]\n"), {"not inside", "waveform", "-20"});
  check_contains(said_of("gate = [\"0 ns\", \"290 ns\"]\n"), "not inside the waveform");
  check_contains(said_of("shaping = { order = 11, time_constant = \"5 ns\" }\n"), "1 to 10 integrators");
  check_contains(said_of("shaping = { order = 1 }\n"), "time_constant");
  check_contains(said_of("shaping = { order = 1, time_constant = \"5 ns\", rise = \"1 ns\" }\n"), "no rise");
  check_contains(said_of("shaping = { rise = \"1 ns\" }\n"), "decay");
  check_contains(said_of("shaping = { decay = \"1 ns\", order = 1 }\n"), "order");
  check_contains(said_of("noise = -1\n"), "cannot be negative");
  check_contains(said_of("adc_bits = 12\n"), "adc_range");
  check_contains(said_of("adc_range = [0, 5]\n"), "adc_bits");
  check_contains(said_of("adc_bits = 12\nadc_range = [5, 0]\n"), "must rise");
  check_contains(said_of("adc_bits = 30\nadc_range = [0, 5]\n"), "1 to 24 bits");
  check_contains(said_of("fraction = 0.2\n"), {"leading edge", "no fraction"});
  check_contains(said_of("delay = \"2 ns\"\n"), {"CFD", "delay"});
  check_contains(said_of("time_pickoff = \"cfd\"\nfraction = 2.0\ndelay = \"2 ns\"\n"), "between 0 and 1");
  check_contains(said_of("time_pickoff = \"cfd\"\nfraction = 0.2\n"), "delay");
  check_contains(said_of("time_pickoff = \"cdf\"\n"), "cfd");
  check_contains(said_of("photon_order = [0]\n"), "whole numbers from 1");
  check_contains(said_of("photon_order = [1.5]\n"), "whole numbers from 1");
  check_contains(said_of("photn_order = [1]\n"), "photon_order");
}

TEST_CASE("all mistakes of a readout are reported at once, each at its place") {
  const auto problems = problems_of(
      [] { readout_of("sampling = \"1 GHz\"\nwindow = \"9 mm\"\nthreshold = -1\nnoise = -2\n"); });
  REQUIRE(problems.size() == 4);  // "before" too
  CHECK(problems[1].where.line == 3);
  CHECK(problems[3].where.line == 4);
}

TEST_CASE("a readout without shaping and a sensor without a pulse are refused together, at the readout") {
  const std::string scene = R"(ambient = "vacuum"
[[part]]
name = "sensor"
box = ["2 mm", "2 mm", "1 mm"]
sensor = "ideal"
[source]
type = "photons"
position = ["0 mm", "0 mm", "2 mm"]
wavelength = "420 nm"
photons = 1
[readout]
sampling = "1 GHz"
before = "20 ns"
window = "300 ns"
threshold = 2.5
)";
  const auto build = [](const std::string& text) {
    SceneBuilder().build(SceneFile::from_text(text, source_file("scene.toml").string()).spec(0));
  };
  const auto problems = problems_of([&] { build(scene); });
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].where.line == 11);
  check_contains(problems[0].what, {"sensor \"ideal\"", "neither", "electronics"});
  check_contains(problems[0].hint, "[readout] shaping");
  CHECK(complaint_of([&] { build(scene + "shaping = { order = 1, time_constant = \"5 ns\" }\n"); }).empty());
}
