#pragma once
/// Normal deviates: one, two and many at once.

#include <span>

#include "scintray/core/lane_width.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/sampling_laws.hpp"

namespace scintray::core {

/// Two independent standard normal deviates.
inline IndependentPair<double> sample_normal_pair(Rng& rng) {
  const double for_radius = rng.uniform_positive();
  return normal_deviates<double>(for_radius, rng.uniform());
}

/// Standard normal deviate.
inline double sample_normal(Rng& rng) { return sample_normal_pair(rng).first; }

/// Standard normal deviates: those of sample_normal_pair() one after the other, to the last bit; of an odd
/// number of them, the second of the last pair is left out.
/// @param lane_width  deviates computed at once, of lane_widths()
void sample_normals(Rng& rng, std::span<double> deviates, int lane_width = default_lane_width());

}  // namespace scintray::core
