#pragma once
/// Paths of single photons of a run, for pictures.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/simulation/simulation_point.hpp"

namespace scintray::simulation {

/// A place at which a photon's path begins, bends or ends.
struct PathVertex {
  core::Vec3 position;  ///< world, mm
  double time_ns = 0.0;
  double wavelength_nm = 0.0;
  std::string event;  ///< what happened there, in words
};

/// The path of one photon, as the run with the same seed traces it.
struct PhotonPath {
  std::uint64_t event = 0, photon = 0;
  core::Fate fate = {};
  std::vector<PathVertex> vertices;  ///< at least two
};

/// A step event in words, with the names of what it happened at.
std::string step_text(const scene::Scene& scene, const transport::Step& step);

/// Paths of the first `count` photons; of an event source, of photons evenly distributed over each of its
/// first events with light, at most ten. Fewer where the source has fewer. The path of a photon that escapes
/// ends a tenth of the scene's diagonal beyond its last boundary.
std::vector<PhotonPath> photon_paths(const SimulationPoint& point, std::uint64_t count);

}  // namespace scintray::simulation
