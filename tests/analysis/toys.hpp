#pragma once
/// Made-up pulses, light and times with known truth.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::test {

inline core::Rng toy_rng(std::uint64_t number, std::uint64_t toy = 0) {
  return core::Rng(20'261'122, core::StreamKind::other, number, toy);
}

/// Poisson deviate: waiting times of unit rate that fit into `mean`.
inline int sample_poisson(double mean, core::Rng& rng) {
  int count = -1;
  for (double sum = 0.0; sum <= mean; ++count) sum += core::sample_exponential(rng);
  return count;
}

/// Detection times of one event: a Poisson number of photons, each delayed by decay, rise and jitter.
inline std::vector<double> sample_photon_times(double photons, double decay_ns, double rise_ns,
                                               double jitter_ns, core::Rng& rng) {
  std::vector<double> times(static_cast<std::size_t>(sample_poisson(photons, rng)));
  for (double& time : times) {
    time = decay_ns * core::sample_exponential(rng);
    if (rise_ns > 0.0) time += rise_ns * core::sample_exponential(rng);
    if (jitter_ns > 0.0) time += jitter_ns * core::sample_normal(rng);
  }
  std::sort(times.begin(), times.end());
  return times;
}

/// Collects (estimate - truth) / error over toys.
struct Pulls {
  core::Moments moments;

  void add(const core::Estimate& estimate, double truth) {
    moments.add((estimate.value - truth) / estimate.error);
  }
  core::Estimate mean() const { return moments.mean(); }
  /// With its error for Gaussian pulls.
  core::Estimate width() const {
    const double width = moments.standard_deviation();
    return {width, 1.0 / std::sqrt(2.0 * static_cast<double>(moments.count))};
  }
};

}  // namespace scintray::test
