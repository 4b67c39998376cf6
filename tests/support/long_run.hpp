#pragma once
/// Tests of "no photon is lost", as long as one likes.

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "scintray/simulation/simulation_point.hpp"

namespace scintray::test {

/// SCINTRAY_TORTURE_STEPS (1e9), or the number without it.
inline double wanted_steps(double usual) {
  const char* given = std::getenv("SCINTRAY_TORTURE_STEPS");
  return given == nullptr ? usual : std::atof(given);
}

/// Traces a scene with one seed after the other until it has made so many steps; no photon may be lost.
inline void lose_no_photon(const std::string& name, scene_file::SceneSpec spec, double steps) {
  const auto built = std::make_shared<const scene::BuiltScene>(scene::SceneBuilder().build(spec));
  double made = 0.0;
  std::uint64_t photons = 0, resolved = 0;
  for (spec.run.seed = 1; made < steps; ++spec.run.seed) {
    const simulation::SimulationPoint point(spec, built);
    const tally::PointResult result = point.trace();
    REQUIRE(result.lost == 0);
    REQUIRE(result.photons == point.work());
    made += static_cast<double>(result.segments);
    photons += result.photons;
    resolved += result.resolved_misses;
  }
  MESSAGE(name << ": " << made << " steps of " << photons << " photons, 0 lost, " << resolved
               << " ray queries settled by the exact search");
}

}  // namespace scintray::test
