#pragma once
/// Values in groups that are left out in turn, for errors by the jackknife.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace scintray::analysis {

/// Number of divisions of a sample, and of groups in each.
struct Divisions {
  std::size_t number = 1, groups = 32;
};

/// The finite values of a list in rising order, each with its place in the list.
class GroupedValues {
 public:
  explicit GroupedValues(std::span<const double> values);

  /// All values, rising.
  const std::vector<double>& sorted() const { return sorted_; }
  /// Leaves out the values outside [low, high].
  void keep_between(double low, double high);
  /// Random divisions of the places, not of the ranks, into groups of equal size within one: divisions of
  /// ranks would be the same in all lists of one length, and so would their deviations.
  /// @return for each division the group of each of sorted()
  std::vector<std::vector<unsigned char>> divided(const Divisions& divisions) const;

 private:
  std::vector<double> sorted_;
  std::vector<std::size_t> place_;
};

/// Standard errors of the results of `statistics`, from those without each of the groups
/// (core::jackknife_error), as the root mean square over the divisions; the calls are parallel. Few, large
/// groups suit statistics that depend on the values in steps, such as fits whose ranges are determined from
/// them: G groups enlarge steps by the square root of G - 1. Nothing where a call returns nothing, or there
/// are fewer than four values per group.
/// @param statistics  of rising values without a group: the same number of results each time, or nothing
std::optional<std::vector<double>> jackknife_errors(
    const GroupedValues& values, const Divisions& divisions,
    const std::function<std::optional<std::vector<double>>(std::span<const double>)>& statistics);

}  // namespace scintray::analysis
