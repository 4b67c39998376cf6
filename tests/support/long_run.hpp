#pragma once
/// Tests of "no photon is lost", as long as one likes.

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "scintray/source/photon_source.hpp"
#include "scintray/trace/run.hpp"

namespace scintray::test {

/// SCINTRAY_TORTURE_STEPS (1e9), or the number without it.
inline double wanted_steps(double usual) {
  const char* given = std::getenv("SCINTRAY_TORTURE_STEPS");
  return given == nullptr ? usual : std::atof(given);
}

/// Traces a scene with one seed after the other until it has made so many steps; no photon may be lost.
inline void lose_no_photon(const std::string& name, const SceneSpec& spec, const Scene& scene, double steps) {
  const PhotonSource source(spec.source, scene);
  const TallyPlan plan(scene, spec);
  RunSettings settings;
  settings.max_interactions = spec.run.max_interactions;
  double made = 0.0;
  std::uint64_t photons = 0, resolved = 0;
  for (settings.seed = 1; made < steps; ++settings.seed) {
    const PointResult result = run_point(scene, source, plan, settings);
    REQUIRE(result.lost == 0);
    REQUIRE(result.photons == source.photons());
    made += static_cast<double>(result.segments);
    photons += result.photons;
    resolved += result.resolved_misses;
  }
  MESSAGE(name << ": " << made << " steps of " << photons << " photons, 0 lost, " << resolved
               << " ray queries settled by the exact search");
}

}  // namespace scintray::test
