#pragma once
/// Errors of what is made of a list of values, by leaving out groups of them.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace scintray::analysis {

/// How often a sample is divided at random, and into how many groups of one size, give or take one.
struct Divisions {
  std::size_t number = 1, groups = 32;
};

/// Numbers that are made of rising values: as many each time, or nothing.
using Statistics = std::function<std::optional<std::vector<double>>(std::span<const double>)>;

/// Standard errors of `statistics`, from its results without one of the groups each (core::jackknife_error),
/// the mean square of several divisions; the calls are parallel. Few, large groups suit what depends on the
/// values in steps, as fits whose ranges are found from them: G groups enlarge what a step adds by the root
/// of G - 1. Nothing where a call returns nothing, or there are fewer than four values a group.
/// @param sorted  rising
std::optional<std::vector<double>> jackknife_errors(std::span<const double> sorted,
                                                    const Divisions& divisions, const Statistics& statistics);

}  // namespace scintray::analysis
