// Traced events, analyzed: depth is resolved in a ground crystal and not in a polished one.
#include <doctest/doctest.h>

#include "physics/traced.hpp"
#include "scintray/analysis/event_analysis.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

/// A bare crystal 2 x 2 x 20 mm3 with a sensor at both ends; its sides have this surface.
EventAnalysis dual_ended(const std::string& sides) {
  const Traced traced = trace(fmt::format(R"(
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "LSO_roncali2013"
surface = "{}"
[[part.face]]
name = "low"
select = {{ normal = [0, 0, -1] }}
surface = "flat"
[[part.face]]
name = "high"
select = {{ normal = [0, 0, 1] }}
surface = "flat"
[[part]]
name = "near"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "-z" }}
sensor = "perfect"
[[part]]
name = "far"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "+z" }}
sensor = "perfect"
[source]
type = "gamma_events"
events = 600
region = {{ part = "crystal" }}
energy = "60 keV"
)",
                                          sides));
  AnalysisSetup setup;
  setup.channels_mm = {Vec3(0.0, 0.0, -0.5), Vec3(0.0, 0.0, 20.5)};
  setup.depth = DepthAxis{};
  setup.ratio = EndRatio::logarithm;
  return analyze_events(traced.events, setup);
}

}  // namespace

TEST_CASE("Ground sides resolve depth of interaction, polished ones do not") {
  const EventAnalysis ground = dual_ended("lso_ground_30um");
  REQUIRE(ground.doi);
  CHECK(ground.pulses == 600);
  const double middle = ground.doi->calibration.depth(0.0);
  // Alike ends: equal light is the middle of the crystal. The calibration there has the error of a slice's
  // mean.
  const double error = ground.doi->residual.quantile_fwhm.value / kFwhmPerSigma / std::sqrt(15.0);
  CHECK(std::abs(middle - 10.0) < kSigmas * error);
  CHECK(ground.doi->residual.quantile_fwhm.value < 3.0);

  // Light in a polished crystal goes to the ends in equal shares but for absorption: there is no answer, or
  // one that is several times worse.
  const EventAnalysis polished = dual_ended("flat");
  CHECK((!polished.doi ||
         polished.doi->residual.quantile_fwhm.value > 3.0 * ground.doi->residual.quantile_fwhm.value));
  // What the ground sides scatter out of the crystal is the price.
  CHECK(polished.mean_light.value > ground.mean_light.value + kSigmas * ground.mean_light.error);
}
