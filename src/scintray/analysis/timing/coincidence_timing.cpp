#include "scintray/analysis/timing/coincidence_timing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "scintray/analysis/position/detail/depth_slices.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kLeastPairs = 50, kLeastOfSlice = 100;

OrderTiming timing_of(std::size_t n, const std::vector<double>& times) {
  return {n, times.size(), mean_of(times), spread_of(paired_differences(times)).quantile_fwhm};
}

std::vector<double> finite(const std::vector<double>& times) {
  std::vector<double> known;
  for (const double time : times)
    if (std::isfinite(time)) known.push_back(time);
  return known;
}

/// Index of the smallest CTR; 0 when there is none.
std::size_t smallest(const std::vector<OrderTiming>& all) {
  return static_cast<std::size_t>(std::min_element(all.begin(), all.end(),
                                                   [](const OrderTiming& a, const OrderTiming& b) {
                                                     return a.ctr_fwhm_ns.value < b.ctr_fwhm_ns.value;
                                                   }) -
                                  all.begin());
}

}  // namespace

std::vector<double> paired_differences(std::span<const double> times_ns) {
  std::vector<double> differences;
  const double* waiting = nullptr;
  for (const double& time : times_ns) {
    if (!std::isfinite(time)) continue;
    if (waiting) differences.push_back(*waiting - time);
    waiting = waiting ? nullptr : &time;
  }
  return differences;
}

std::vector<double> channel_differences(std::span<const double> a_ns, std::span<const double> b_ns) {
  if (a_ns.size() != b_ns.size()) throw std::invalid_argument("two channels differ in number of events");
  std::vector<double> differences;
  for (std::size_t i = 0; i < a_ns.size(); ++i)
    if (std::isfinite(a_ns[i]) && std::isfinite(b_ns[i])) differences.push_back(a_ns[i] - b_ns[i]);
  return differences;
}

core::Estimate quoted_fwhm(const Spread& differences) { return differences.quantile_fwhm; }

void FirstPhotons::add(std::uint64_t event, double time_ns) {
  if (most_ == 0 || !std::isfinite(time_ns)) return;
  std::vector<double>& heap = heaps_[event];
  if (heap.size() == most_) {
    if (time_ns >= heap.front()) return;
    std::pop_heap(heap.begin(), heap.end());
    heap.pop_back();
  }
  heap.push_back(time_ns);
  std::push_heap(heap.begin(), heap.end());
}

std::vector<std::vector<double>> FirstPhotons::times_ns() const {
  std::vector<std::uint64_t> events;
  for (const auto& [event, heap] : heaps_) events.push_back(event);
  std::sort(events.begin(), events.end());
  std::vector<std::vector<double>> all;
  for (const std::uint64_t event : events) {
    all.push_back(heaps_.at(event));
    std::sort(all.back().begin(), all.back().end());
  }
  return all;
}

OrderAnalysis analyze_orders(std::span<const OrderTimes> choices) {
  OrderAnalysis analysis;
  for (const OrderTimes& choice : choices) {
    const std::vector<double> single = finite(choice.single), average = finite(choice.average);
    if (single.size() >= 2 * kLeastPairs) analysis.single.push_back(timing_of(choice.n, single));
    if (average.size() >= 2 * kLeastPairs) analysis.average.push_back(timing_of(choice.n, average));
  }
  analysis.best_single = smallest(analysis.single);
  analysis.best_average = smallest(analysis.average);
  return analysis;
}

OrderAnalysis analyze_orders(std::span<const std::vector<double>> times_ns, std::size_t most) {
  std::vector<OrderTimes> choices;
  std::vector<double> sums(times_ns.size(), 0.0);
  for (std::size_t n = 1; n <= most; ++n) {
    OrderTimes choice;
    choice.n = n;
    for (std::size_t event = 0; event < times_ns.size(); ++event) {
      if (times_ns[event].size() < n) continue;
      sums[event] += times_ns[event][n - 1];
      choice.single.push_back(times_ns[event][n - 1]);
      choice.average.push_back(sums[event] / static_cast<double>(n));
    }
    if (choice.single.empty()) break;
    choices.push_back(std::move(choice));
  }
  return analyze_orders(choices);
}

std::vector<OrderSlice> orders_against_depth(std::span<const double> depths_mm,
                                             std::span<const OrderTimes> choices,
                                             std::span<const double> photons, std::size_t slices) {
  std::vector<double> numbers(depths_mm.size());
  std::iota(numbers.begin(), numbers.end(), 0.0);
  std::vector<OrderSlice> all;
  for (const DepthSlice& slice : slice_by_depth(depths_mm, numbers, slices, kLeastOfSlice)) {
    const auto picked = [&](std::span<const double> of_events) {
      if (of_events.size() != depths_mm.size())
        throw std::invalid_argument("times of another number of events than depths");
      std::vector<double> some;
      for (const double number : slice.values) some.push_back(of_events[static_cast<std::size_t>(number)]);
      return some;
    };
    std::vector<OrderTimes> of_slice;
    for (const OrderTimes& choice : choices) {
      of_slice.push_back({choice.n, picked(choice.single), {}});
      if (!choice.average.empty()) of_slice.back().average = picked(choice.average);
    }
    OrderSlice found{slice.depth_mm, slice.values.size(), mean_of(picked(photons)).value,
                     analyze_orders(of_slice)};
    if (!found.orders.single.empty()) all.push_back(std::move(found));
  }
  return all;
}

TimingDepth timing_against_depth(std::span<const double> depths_mm, std::span<const double> times_ns,
                                 std::size_t slices) {
  TimingDepth timing;
  std::vector<double> depths;
  std::vector<core::Estimate> means;
  for (const DepthSlice& slice : slice_by_depth(depths_mm, times_ns, slices, kLeastOfSlice)) {
    timing.slices.push_back({slice.depth_mm, slice.values.size(), mean_of(slice.values),
                             spread_of(paired_differences(slice.values)).quantile_fwhm});
    depths.push_back(slice.depth_mm);
    means.push_back(timing.slices.back().mean_ns);
  }
  const bool spread =
      depths.size() > 1 &&
      std::all_of(means.begin(), means.end(), [](const core::Estimate& mean) { return mean.error > 0.0; });
  if (spread) timing.line = fit_line(depths, means);
  return timing;
}

}  // namespace scintray::analysis
