#pragma once
/// Coincidence timing resolution (CTR) from times of events.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "scintray/analysis/position/depth_curve.hpp"
#include "scintray/analysis/spectrum/spread.hpp"

namespace scintray::analysis {

/// Differences of the times of events 0 and 1, 2 and 3, and so on: two detectors like the simulated one in
/// coincidence. No event is used twice, so that differences are independent. Times that are not finite are
/// removed first.
std::vector<double> paired_differences(std::span<const double> times_ns);

/// Differences a - b of every event that has both. @throws std::invalid_argument when the sizes differ
std::vector<double> channel_differences(std::span<const double> a_ns, std::span<const double> b_ns);

/// The CTR to quote: that between the quantiles, which is one quantity for any number of events. (The fitted
/// width is another one where the differences are not Gaussian, which few events do not show.)
core::Estimate quoted_fwhm(const Spread& differences);

/// Collector of the earliest detected photons of every event, for any number of photons.
class FirstPhotons {
 public:
  explicit FirstPhotons(std::size_t most) : most_(most) {}
  /// Adds a detected photon, in any order.
  void add(std::uint64_t event, double time_ns);
  /// The earliest times, rising, up to `most`, of every event, by event number.
  std::vector<std::vector<double>> times_ns() const;

 private:
  std::size_t most_;
  std::unordered_map<std::uint64_t, std::vector<double>> heaps_;  ///< latest kept time on top
};

/// Timing with one choice of photons.
struct OrderTiming {
  std::size_t n = 0;           ///< from 1
  std::size_t events = 0;      ///< with that many photons
  core::Estimate mean_ns;      ///< of the time itself
  core::Estimate ctr_fwhm_ns;  ///< of pairs of events, between quantiles
};

/// Times of events with one choice of photons; not a number where an event has fewer.
struct OrderTimes {
  std::size_t n = 0;
  std::vector<double> single;   ///< of the n-th photon
  std::vector<double> average;  ///< mean of the first n; empty: not available
};

struct OrderAnalysis {
  std::vector<OrderTiming> single;   ///< time of the n-th photon
  std::vector<OrderTiming> average;  ///< mean time of the first n photons
  std::size_t best_single = 0;       ///< index of the smallest CTR; 0 when empty
  std::size_t best_average = 0;
};

/// CTR with each choice of photons, from independent events paired as in paired_differences. Choices
/// available for fewer than 50 pairs are left out.
OrderAnalysis analyze_orders(std::span<const OrderTimes> choices);

/// CTR by the n-th detected photon and by the mean of the first n, each for n = 1 to `most`, from independent
/// events paired as in paired_differences. Where fewer than 50 pairs have n photons the list ends. The best
/// is the smallest of numbers with errors, so it is biased low by a part of its error.
/// @param times_ns  of each event, rising
OrderAnalysis analyze_orders(std::span<const std::vector<double>> times_ns, std::size_t most);

/// Timing by order of photons at one depth.
struct OrderSlice {
  double depth_mm = 0.0;
  std::size_t count = 0;
  double photons = 0.0;  ///< detected per event, mean
  OrderAnalysis orders;
};

/// Timing by order of photons against depth, in slices of equal thickness; those with fewer than 100 events
/// are left out.
/// @param choices  times of as many events as there are depths and numbers of photons (std::invalid_argument)
std::vector<OrderSlice> orders_against_depth(std::span<const double> depths_mm,
                                             std::span<const OrderTimes> choices,
                                             std::span<const double> photons, std::size_t slices = 10);

struct TimingSlice {
  double depth_mm = 0.0;
  std::size_t count = 0;
  core::Estimate mean_ns;      ///< of the time
  core::Estimate ctr_fwhm_ns;  ///< of pairs of events of this depth, between quantiles
};

struct TimingDepth {
  std::vector<TimingSlice> slices;
  StraightLine line;  ///< of the mean time, ns, against depth, mm; zeros with fewer than two slices
};

/// Timing against depth, in slices of equal thickness; those with fewer than 100 events are left out.
TimingDepth timing_against_depth(std::span<const double> depths_mm, std::span<const double> times_ns,
                                 std::size_t slices = 10);

}  // namespace scintray::analysis
