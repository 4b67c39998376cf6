#include "scintray/analysis/position/detail/watershed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace scintray::analysis {

namespace {

/// Standard errors above the saddle from which a peak is kept; fewer where the number of peaks is known and
/// only the most significant are kept.
constexpr double kSignificance = 5.0;

/// Calls a function for the up to eight cells around one.
template <typename Visit>
void around(std::size_t cell, std::size_t rows, std::size_t columns, Visit visit) {
  const std::size_t row = cell / columns, column = cell % columns;
  for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(rows - 1, row + 1); ++r)
    for (std::size_t c = column == 0 ? 0 : column - 1; c <= std::min(columns - 1, column + 1); ++c)
      if (r != row || c != column) visit(r * columns + c);
}

/// Cells above the floor, highest first; equal ones by index, so that the result is unique.
std::vector<std::size_t> falling(const std::vector<double>& height, double floor) {
  std::vector<std::size_t> cells(height.size());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  std::erase_if(cells, [&](std::size_t cell) { return !(height[cell] > floor); });
  std::stable_sort(cells.begin(), cells.end(),
                   [&](std::size_t a, std::size_t b) { return height[a] > height[b]; });
  return cells;
}

/// Height of every maximum above its saddle to a higher one; infinite for the highest of all.
std::map<std::size_t, double> persistences(const std::vector<double>& height, std::size_t rows,
                                           std::size_t columns, const std::vector<std::size_t>& order) {
  constexpr auto kDry = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> parent(height.size(), kDry);  // towards the maximum of the component
  const auto top = [&](std::size_t cell) {
    while (parent[cell] != cell) cell = parent[cell] = parent[parent[cell]];
    return cell;
  };
  std::map<std::size_t, double> found;
  for (const std::size_t cell : order) {
    parent[cell] = cell;
    found[cell] = std::numeric_limits<double>::infinity();
    around(cell, rows, columns, [&](std::size_t beside) {
      if (parent[beside] == kDry) return;
      std::size_t a = top(cell), b = top(beside);
      if (a == b) return;
      if (height[a] < height[b] || (height[a] == height[b] && a > b)) std::swap(a, b);
      found[b] = height[b] - height[cell];
      if (b == cell) found.erase(b);  // not a maximum
      parent[b] = a;
    });
  }
  return found;
}

}  // namespace

Basins find_basins(const std::vector<double>& height, std::size_t rows, std::size_t columns, double floor,
                   double error_scale, std::optional<std::size_t> most) {
  const std::vector<std::size_t> order = falling(height, floor);
  std::vector<std::pair<double, std::size_t>>
      standing;  // height above the saddle in roots of the height, cell
  for (const auto& [cell, above] : persistences(height, rows, columns, order)) {
    const double standing_out = above / std::sqrt(height[cell]);
    if (standing_out > kSignificance * error_scale) standing.emplace_back(standing_out, cell);
  }
  std::stable_sort(standing.begin(), standing.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (most && standing.size() > *most) standing.resize(*most);

  Basins basins;
  for (const auto& [above, cell] : standing) basins.peaks.push_back(cell);
  std::stable_sort(basins.peaks.begin(), basins.peaks.end(),
                   [&](std::size_t a, std::size_t b) { return height[a] > height[b]; });
  basins.of_cell.assign(height.size(), Basins::kNone);
  for (std::uint32_t i = 0; i < basins.peaks.size(); ++i) basins.of_cell[basins.peaks[i]] = i;
  // Each cell follows its highest neighbour that has a basin; removed maxima follow later.
  std::vector<std::size_t> waiting = order;
  for (bool grew = true; grew && !waiting.empty();) {
    grew = false;
    std::vector<std::size_t> still;
    for (const std::size_t cell : waiting) {
      if (basins.of_cell[cell] != Basins::kNone) continue;
      double highest = -1.0;
      std::uint32_t basin = Basins::kNone;
      around(cell, rows, columns, [&](std::size_t beside) {
        if (basins.of_cell[beside] == Basins::kNone || height[beside] <= highest) return;
        highest = height[beside];
        basin = basins.of_cell[beside];
      });
      if (basin == Basins::kNone) {
        still.push_back(cell);
        continue;
      }
      basins.of_cell[cell] = basin;
      grew = true;
    }
    waiting = std::move(still);
  }
  for (const std::size_t cell : order)
    around(cell, rows, columns, [&](std::size_t beside) {
      const std::uint32_t a = basins.of_cell[cell], b = basins.of_cell[beside];
      if (a >= b || b == Basins::kNone) return;
      double& saddle = basins.saddles[{a, b}];
      saddle = std::max(saddle, std::min(height[cell], height[beside]));
    });
  return basins;
}

}  // namespace scintray::analysis
