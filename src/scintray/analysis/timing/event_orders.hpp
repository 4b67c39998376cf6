#pragma once
/// Timing by the n-th photons that a readout recorded, and its bounds by emission and time spread.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::analysis {

/// Lower bound on the CTR (FWHM) of two detectors with a number of detected photons per event, for light that
/// reaches the sensors without time of flight (detail/photon_time.hpp). Times of flight only increase the
/// spread, so no unbiased estimate from all detected photons is below the last; those of the first n hold for
/// such light alone.
struct TimingBound {
  double photons = 0.0;          ///< detected per event, mean
  std::vector<double> first_ns;  ///< by the first n photons, one for each n requested
  double all_ns = 0.0;           ///< by all photons
};

/// The bound; empty without a time spread, where there is no such bound, or without photons.
std::optional<TimingBound> timing_bound(const tally::LightTiming& timing, double photons,
                                        std::span<const OrderTiming> orders);

/// Collector of the times of n-th photons of events. Each is the earliest of the event's channels: of the
/// channels' n-th photons, and of their means over the first n.
class OrderCollector {
 public:
  /// @param orders  numbers n of the photons, in any order, from 1
  explicit OrderCollector(std::vector<std::uint64_t> orders);
  /// Adds the next event; its channels have a time for each order, or none.
  void add(const tally::EventRecord& event);
  /// Times of some events, by their number from 0 in the order in which they were added, by rising n.
  /// Means of the first n exist where all photons up to the n-th were requested.
  std::vector<OrderTimes> times(std::span<const std::size_t> events) const;
  bool empty() const { return orders_.empty(); }

 private:
  std::vector<std::uint64_t> orders_;  ///< rising
  std::vector<std::size_t> places_;    ///< indices of these in a record
  std::size_t averaged_ = 0;           ///< orders with a mean
  std::vector<float> single_, average_;
};

}  // namespace scintray::analysis
