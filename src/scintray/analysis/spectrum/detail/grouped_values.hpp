#pragma once
/// Values in groups that are left out in turn, for errors by the jackknife.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace scintray::analysis {

/// How often a sample is divided, and into how many groups.
struct Divisions {
  std::size_t number = 1, groups = 32;
};

/// The finite ones of a list in rising order, each with its place in the list.
class GroupedValues {
 public:
  explicit GroupedValues(std::span<const double> values);

  /// All values, rising.
  const std::vector<double>& sorted() const { return sorted_; }
  /// Leaves out the values outside of two.
  void keep_between(double low, double high);
  /// Random divisions of the places, not of the ranks, into groups of one size, give or take one: those of
  /// ranks would be the same in all lists of one length, and so would what they are off by. @returns  for
  /// each division the group of each of sorted()
  std::vector<std::vector<unsigned char>> divided(const Divisions& divisions) const;

 private:
  std::vector<double> sorted_;
  std::vector<std::size_t> place_;
};

/// Standard errors of what `statistics` makes of rising values, from its results without one of the groups
/// each (core::jackknife_error), the mean square of several divisions; the calls are parallel. Few, large
/// groups suit what depends on the values in steps, as fits whose ranges are found from them: steps of one
/// part in a hundred of the error, which G groups enlarge by the root of G - 1. Nothing where a call returns
/// nothing, or there are fewer than four values a group.
/// @param statistics  of values without a group: as many numbers each time, or nothing
std::optional<std::vector<double>> jackknife_errors(
    const GroupedValues& values, const Divisions& divisions,
    const std::function<std::optional<std::vector<double>>(std::span<const double>)>& statistics);

}  // namespace scintray::analysis
