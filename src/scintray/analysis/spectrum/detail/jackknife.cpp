#include "scintray/analysis/spectrum/detail/jackknife.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "scintray/core/philox.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kLeastPerGroup = 4;

/// The group of each of `count` values.
std::vector<unsigned char> random_groups(std::size_t count, std::size_t groups, std::uint64_t division) {
  std::vector<std::size_t> left(count);
  std::iota(left.begin(), left.end(), std::size_t{0});
  core::Rng rng(division, core::StreamKind::other, count);
  std::vector<unsigned char> group(count);
  for (; !left.empty(); left.pop_back()) {
    const auto at =
        std::min(static_cast<std::size_t>(rng.uniform() * static_cast<double>(left.size())), left.size() - 1);
    group[left[at]] = static_cast<unsigned char>(left.size() % groups);
    left[at] = left.back();
  }
  return group;
}

std::vector<double> without(std::span<const double> sorted, const std::vector<unsigned char>& group,
                            std::size_t left_out) {
  std::vector<double> kept;
  kept.reserve(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (group[i] != left_out) kept.push_back(sorted[i]);
  return kept;
}

}  // namespace

std::optional<std::vector<double>> jackknife_errors(std::span<const double> sorted,
                                                    const Divisions& divisions,
                                                    const Statistics& statistics) {
  if (sorted.size() < kLeastPerGroup * divisions.groups) return std::nullopt;
  std::vector<std::optional<std::vector<double>>> results(divisions.number * divisions.groups);
  tbb::parallel_for(std::size_t{0}, divisions.number, [&](std::size_t division) {
    const std::vector<unsigned char> group = random_groups(sorted.size(), divisions.groups, division);
    tbb::parallel_for(std::size_t{0}, divisions.groups, [&](std::size_t left_out) {
      results[division * divisions.groups + left_out] = statistics(without(sorted, group, left_out));
    });
  });
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
