#pragma once
/// Recorded paths of single photons.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/step_event.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::tally {

/// A place at which a photon's path begins, bends or ends.
struct PathStep {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  double time_ns = 0.0;                      ///< since the event
  double wavelength_nm = 0.0;                ///< after it, in vacuum
  std::string text;                          ///< what happened there, in words
};

/// The path of one photon, as its run traced it.
struct PhotonPath {
  std::uint64_t event = 0, photon = 0;
  core::Fate fate = core::Fate::detected;
  std::vector<PathStep> steps;  ///< at least two: the first is its emission, the last its fate
};

/// Steps of a path that are kept: the first ones, and the last.
inline constexpr std::size_t kMostPathSteps = 10'000;

}  // namespace scintray::tally
