#pragma once
/// Basins of a map, from its peaks down.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace scintray::analysis {

struct Basins {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::size_t> peaks;      ///< cells of the peaks that stand, highest first
  std::vector<std::uint32_t> of_cell;  ///< index into peaks, kNone for cells of no height
  /// Highest saddle of every two basins that touch, the lower index first.
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> saddles;
};

/// @param height  rows x columns; only cells above `floor` belong to a basin
/// @param error_scale  a peak of height h stands when it is more than 5 error_scale sqrt(h) above the saddle
///                  at which it meets a higher one
/// @param most  peaks kept at most, those that stand out most in this measure
Basins find_basins(const std::vector<double>& height, std::size_t rows, std::size_t columns, double floor,
                   double error_scale, std::optional<std::size_t> most);

}  // namespace scintray::analysis
