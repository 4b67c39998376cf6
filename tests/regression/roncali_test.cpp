/// The paper's crystals at the quick setting, with another seed, against the numbers of a quick run.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "scintray/report/acceptance.hpp"
#include "scintray/report/plots/detail/light_curves.hpp"
#include "scintray/report/surface_acceptance.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/agreement.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::simulation;
using namespace scintray::report;

namespace {

/// Photoelectrons at 511 keV that `scintray run scenes/roncali2013/light_output.toml --quick` (seed 1) gives:
/// its table times its reference, which the claim on photons per event prints.
struct Known {
  std::vector<std::string> point;
  Estimate relative;
};
constexpr Estimate kReference{1266.7, 6.7};
const std::vector<Known> kKnown{
    {{"2 mm", "polished_reflector_table", "2 mm"}, {1.0, 0.0}},
    {{"2 mm", "polished_bare_table", "2 mm"}, {0.7172, 0.0042}},
    {{"2 mm", "rough_bare_table", "2 mm"}, {0.4627, 0.0050}},
    {{"2 mm", "rough_bare_table", "18 mm"}, {0.0774, 0.0014}},
    {{"2 mm", "rough_bare_unified", "2 mm"}, {0.5667, 0.0046}},
    {{"2 mm", "rough_bare_unified", "18 mm"}, {0.2338, 0.0027}},
    {{"5 mm", "rough_bare_table", "18 mm"}, {0.3104, 0.0034}},
    {{"5 mm", "rough_reflector_table", "2 mm"}, {1.5160, 0.0058}},
};

std::size_t point_of(const Simulation& simulation, const std::vector<std::string>& parameters) {
  for (std::size_t point = 0; point < simulation.points(); ++point)
    if (simulation.parameters(point) == parameters) return point;
  FAIL("the scene has no such point");
  return 0;
}

/// Photoelectrons at 511 keV of a point.
Estimate light_at(const SimulationPoint& point) {
  AnalysisSetup setup;
  for (const ReadoutChannel& channel : point.plan().channels.list)
    setup.channels_mm.push_back(channel.position);
  EventCollector collector(setup);
  RunHooks hooks;
  hooks.events = [&](const std::vector<EventRecord>& events) {
    for (const EventRecord& event : events) collector.add(event);
  };
  const PointResult result = point.trace(hooks);
  CHECK(result.lost == 0);
  return report::light_of(collector.finish());
}

}  // namespace

TEST_CASE("The paper's crystals have the light that a quick run printed, with another seed") {
  SimulationOptions options;
  options.quick = true;
  options.seed = 2;
  Simulation simulation(SceneFile::load(test::source_file("scenes/roncali2013/light_output.toml")), options);
  CHECK(simulation.points() == 80);
  for (const Known& known : kKnown) {
    CAPTURE(known.point[1]);
    CAPTURE(known.point[2]);
    const Estimate light = light_at(*simulation.point(point_of(simulation, known.point)));
    const double expected = kReference.value * known.relative.value;
    const double error =
        std::hypot(kReference.value * known.relative.error, kReference.error * known.relative.value);
    CHECK(sigmas(light, {expected, error}) < test::kSigmas);
  }
}

TEST_CASE("The curves and surfaces that the paper's acceptance criteria name exist") {
  const SceneFile file = SceneFile::load(test::source_file("scenes/roncali2013/light_output.toml"));
  RunResult points;
  points.header.sweep_keys = file.sweep_keys();
  points.points.resize(file.points());
  for (std::size_t i = 0; i < file.points(); ++i) points.points[i].parameters = file.parameters(i);
  const SceneSpec spec = file.spec(0);
  CHECK(spec.criteria.size() == 27);
  CHECK_NOTHROW(report::check_curves(points, spec.analysis.reference, spec.criteria));
  CHECK_NOTHROW(report::check_surface_criteria(spec.goniometers, spec.criteria));
}
