#pragma once
/// Events sorted into slices of depth.

#include <cstddef>
#include <span>
#include <vector>

#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

struct DepthSlice {
  double depth_mm = 0.0;  ///< mean of its values
  std::vector<double> depths_mm, values;
};

/// Slices of equal thickness between the least and the greatest depth; those with fewer than `least` values
/// are left out. Pairs that are not both finite are left out. @throws std::invalid_argument when the sizes
/// differ.
std::vector<DepthSlice> slice_by_depth(std::span<const double> depths_mm, std::span<const double> values,
                                       std::size_t slices, std::size_t least);

/// Mean of a slice with its standard error.
core::Estimate mean_of(const std::vector<double>& values);

}  // namespace scintray::analysis
