// Electronics rerun from the photons of a result.
#include "scintray/simulation/analyze_results.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/activity.hpp"
#include "scintray/core/error.hpp"
#include "scintray/optics/facets.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene_file/readout.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/shared.hpp"
#include "support/small_crystal.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::results;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

const std::string kElectronics = R"(
[readout]
period = "0.5 ns"
before = "5 ns"
window = "200 ns"
shaping = { order = 1, time_constant = "5 ns" }
noise = 0.2
threshold = 3
pulses = true
photon_order = [1, 3]
)";

struct Made {
  std::filesystem::path path;
  RunResult run;
};

Made made(const std::string& name, const std::string& more) {
  const auto output = scratch_folder("read_out_" + name) / "run.h5";
  ResultsFile results(output);
  Simulation(
      SceneFile::from_text(kSmallCrystal + more, (scratch_folder("read_out_scene") / "scene.toml").string()))
      .run_all(results);
  return {output, read_results(output)};
}

std::string refusal(const Made& of, const std::filesystem::path& output) {
  try {
    rerun_readout(of.path, of.run, readout_of_text(kElectronics, "other.toml"), output);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("The electronics of the run reproduce its own signals, others make theirs") {
  const Made traced = made("same", kElectronics + "[run]\nphoton_list = true\n");
  const auto again = traced.path.parent_path() / "again.h5";
  std::vector<Activity> seen;
  {
    const ActivityObserver observer([&](const Activity& activity) { seen.push_back(activity); });
    rerun_readout(traced.path, traced.run, readout_of_text(kElectronics, "same.toml"), again);
  }
  CHECK(std::any_of(seen.begin(), seen.end(), [](const Activity& activity) {
    return activity.what == "applying the electronics" && activity.total > 0;
  }));
  const auto before = read_events(traced.path, 0, 100), after = read_events(again, 0, 100);
  REQUIRE(after.size() == before.size());
  REQUIRE(before.size() == 5);
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(after[i].energy_keV == before[i].energy_keV);
    CHECK(after[i].detected == before[i].detected);
    REQUIRE(after[i].channels.size() == 1);
    const ChannelRecord &a = after[i].channels[0], &b = before[i].channels[0];
    CHECK(b.charge > 100.0F);
    CHECK(a.detected == b.detected);
    // Arrivals are recorded in single precision, 1e-5 ns of times of some 100 ns.
    CHECK(a.charge == doctest::Approx(b.charge).epsilon(1e-4));
    CHECK(a.amplitude == doctest::Approx(b.amplitude).epsilon(1e-3));
    CHECK(std::abs(a.time_ns - b.time_ns) < 1e-3F);
    CHECK(std::abs(a.order_ns.at(1) - b.order_ns.at(1)) < 1e-4F);
    REQUIRE(a.waveform.size() == b.waveform.size());
    for (std::size_t k = 0; k < a.waveform.size(); ++k)
      CHECK(std::abs(a.waveform[k] - b.waveform[k]) < 0.02F);
  }
  check_contains(read_results(again).header.note, "electronics applied again by same.toml");

  // Half the gate, of a run without electronics: less charge of the same photons.
  const Made bare = made("bare", "[run]\nphoton_list = true\n");
  const auto gated = bare.path.parent_path() / "gated.h5";
  rerun_readout(bare.path, bare.run,
                readout_of_text(kElectronics + "gate = [\"-5 ns\", \"20 ns\"]\n", "gated.toml"), gated);
  const auto short_gate = read_events(gated, 0, 100);
  REQUIRE(short_gate.size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(short_gate[i].channels[0].detected == before[i].channels[0].detected);
    CHECK(short_gate[i].channels[0].charge < 0.6F * before[i].channels[0].charge);
    CHECK(short_gate[i].channels[0].charge > 0.1F * before[i].channels[0].charge);
  }
}

TEST_CASE("Electronics are rerun in a scene that names a surface model from outside") {
  SimulationOptions options;
  options.models.surfaces.add({.word = "outside", .table = "", .read = [](const config::TomlTable&) {
                                 return materials::FixedMicrosurface(optics::FacetSurface());
                               }});
  const auto folder = scratch_folder("read_out_model");
  const std::string scene =
      kSmallCrystal + kElectronics + "[run]\nphoton_list = true\n[surfaces.own]\nmodel = \"outside\"\n";
  {
    ResultsFile results(folder / "run.h5");
    Simulation(SceneFile::from_text(scene, (folder / "scene.toml").string()), options).run_all(results);
  }
  const RunResult run = read_results(folder / "run.h5");
  const auto readout = readout_of_text(kElectronics, "same.toml");
  CHECK_THROWS_AS(rerun_readout(folder / "run.h5", run, readout, folder / "without.h5"), InputError);
  rerun_readout(folder / "run.h5", run, readout, folder / "again.h5", options);
  CHECK(read_events(folder / "again.h5", 0, 100).size() == read_events(folder / "run.h5", 0, 100).size());
}

TEST_CASE("What cannot be read out again is refused with the reason") {
  const Made unlisted = made("unlisted", "");
  check_contains(refusal(unlisted, unlisted.path.parent_path() / "new.h5"), "photon_list = true");
  const Made listed = made("listed", "[run]\nphoton_list = true\n");
  check_contains(refusal(listed, listed.path), "would replace");
  CHECK_THROWS_AS(readout_of_text("title = \"x\"\n", "none.toml"), InputError);
}
