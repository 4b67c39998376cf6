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
  std::vector<std::size_t> peaks;      ///< cells of the peaks that are kept, highest first
  std::vector<std::uint32_t> of_cell;  ///< index into peaks, kNone for cells not above `floor`
  /// Highest saddle of every two adjacent basins, the lower index first.
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> saddles;
};

/// Basins of a map by watershed with removal of insignificant peaks (sources: flood_map.hpp).
/// @param height  rows x columns; only cells above `floor` belong to a basin
/// @param error_scale  a peak of height h is kept when it is more than 5 error_scale sqrt(h) above the saddle
///                  to a higher one
/// @param most  limit of the peaks kept, the most significant ones in this measure
Basins find_basins(const std::vector<double>& height, std::size_t rows, std::size_t columns, double floor,
                   double error_scale, std::optional<std::size_t> most);

}  // namespace scintray::analysis
