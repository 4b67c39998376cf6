#include "scintray/analysis/spectrum/detail/grouped_values.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "scintray/core/in_order.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kLeastPerGroup = 4;

std::vector<double> without(const std::vector<double>& sorted, const std::vector<unsigned char>& group,
                            std::size_t left_out) {
  std::vector<double> kept;
  kept.reserve(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (group[i] != left_out) kept.push_back(sorted[i]);
  return kept;
}

}  // namespace

GroupedValues::GroupedValues(std::span<const double> values) {
  std::vector<std::pair<double, std::size_t>> found;
  found.reserve(values.size());
  for (const double value : values)
    if (std::isfinite(value)) found.emplace_back(value, found.size());
  std::sort(found.begin(), found.end());
  for (const auto& [value, place] : found) {
    sorted_.push_back(value);
    place_.push_back(place);
  }
}

void GroupedValues::keep_between(double low, double high) {
  const auto first = std::lower_bound(sorted_.begin(), sorted_.end(), low) - sorted_.begin();
  const auto last = std::upper_bound(sorted_.begin() + first, sorted_.end(), high) - sorted_.begin();
  sorted_ = {sorted_.begin() + first, sorted_.begin() + last};
  place_ = {place_.begin() + first, place_.begin() + last};
}

std::vector<std::vector<unsigned char>> GroupedValues::divided(const Divisions& divisions) const {
  // By order of place, so that it depends on the list alone.
  std::vector<std::size_t> by_place(sorted_.size());
  std::iota(by_place.begin(), by_place.end(), std::size_t{0});
  std::sort(by_place.begin(), by_place.end(),
            [&](std::size_t a, std::size_t b) { return place_[a] < place_[b]; });
  std::vector<std::vector<unsigned char>> group_of;
  for (std::size_t number = 0; number < divisions.number; ++number) {
    core::Rng rng(number, core::StreamKind::other, sorted_.size());
    std::vector<std::size_t> order = by_place;
    std::vector<unsigned char>& group = group_of.emplace_back(sorted_.size());
    for (std::size_t left = order.size(); left > 0; --left) {
      const auto at = std::min(static_cast<std::size_t>(rng.uniform() * static_cast<double>(left)), left - 1);
      group[order[at]] = static_cast<unsigned char>(left % divisions.groups);
      order[at] = order[left - 1];
    }
  }
  return group_of;
}

std::optional<std::vector<double>> jackknife_errors(
    const GroupedValues& values, const Divisions& divisions,
    const std::function<std::optional<std::vector<double>>(std::span<const double>)>& statistics) {
  const std::vector<double>& sorted = values.sorted();
  if (sorted.size() < kLeastPerGroup * divisions.groups) return std::nullopt;
  const std::vector<std::vector<unsigned char>> group_of = values.divided(divisions);
  using Result = std::optional<std::vector<double>>;
  std::vector<Result> results;
  core::work_in_order(
      divisions.number * divisions.groups, 0, nullptr,
      [&](std::uint64_t k) {
        return statistics(without(sorted, group_of[k / divisions.groups], k % divisions.groups));
      },
      [&](std::uint64_t, Result& result) { results.push_back(std::move(result)); });
  if (std::any_of(results.begin(), results.end(), [](const auto& result) { return !result; }))
    return std::nullopt;
  std::vector<double> errors(results.front()->size()), column(divisions.groups);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    double squares = 0.0;
    for (std::size_t division = 0; division < divisions.number; ++division) {
      for (std::size_t i = 0; i < divisions.groups; ++i)
        column[i] = (*results[division * divisions.groups + i])[k];
      const double error = core::jackknife_error(column);
      squares += error * error;
    }
    errors[k] = std::sqrt(squares / static_cast<double>(divisions.number));
  }
  return errors;
}

}  // namespace scintray::analysis
