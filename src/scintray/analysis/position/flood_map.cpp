#include "scintray/analysis/position/flood_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "scintray/analysis/position/detail/watershed.hpp"
#include "scintray/analysis/spectrum/detail/smoothing.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kLeastPlaced = 100;
/// Standard deviations of the kernels, in distances of peaks, and that distance where their number is not
/// known.
constexpr std::array kKernels{0.25, 0.18, 0.125, 0.09, 0.063, 0.045};
constexpr double kDistanceOfSide = 0.08;
/// Cells whose smoothed height is below this share of the highest do not belong to a basin.
constexpr double kFloor = 1e-6;

FloodGrid grid_of(std::span<const std::array<double, 2>> positions, std::size_t cells) {
  std::array<double, 2> low{}, high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const std::array<double, 2>& position : positions)
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], position[k]);
      high[k] = std::max(high[k], position[k]);
    }
  if (!(high[0] > low[0]) || !(high[1] > low[1]))
    throw core::InputError(
        core::Problem{{}, "all events of the flood map lie on one line", "use channels in two directions"});
  // A margin, so that the outermost peaks decrease on all sides.
  const double margin = 0.03 * std::max(high[0] - low[0], high[1] - low[1]);
  FloodGrid grid;
  grid.x_low = low[0] - margin;
  grid.x_high = high[0] + margin;
  grid.y_low = low[1] - margin;
  grid.y_high = high[1] + margin;
  const double width = grid.x_high - grid.x_low, height = grid.y_high - grid.y_low;
  const double cell = std::max(width, height) / static_cast<double>(std::max<std::size_t>(8, cells));
  grid.columns = static_cast<std::size_t>(std::max(1.0, std::round(width / cell)));
  grid.rows = static_cast<std::size_t>(std::max(1.0, std::round(height / cell)));
  grid.counts.assign(grid.rows * grid.columns, 0.0);
  for (const std::array<double, 2>& position : positions) grid.counts[grid.cell(position)] += 1.0;
  return grid;
}

std::array<double, 2> middle_of(const FloodGrid& grid, std::size_t cell) {
  const auto along = [](double low, double high, std::size_t i, std::size_t n) {
    return low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  };
  return {along(grid.x_low, grid.x_high, cell % grid.columns, grid.columns),
          along(grid.y_low, grid.y_high, cell / grid.columns, grid.rows)};
}

struct Segmentation {
  double smoothing_mm = 0.0;
  std::vector<double> height;  ///< the smoothed map
  Basins basins;
};

/// The coarsest smoothing that shows the most peaks.
Segmentation segment(const FloodGrid& grid, std::optional<std::size_t> most) {
  const double width = grid.x_high - grid.x_low, height = grid.y_high - grid.y_low;
  const double cell_mm = width / static_cast<double>(grid.columns);
  const double distance_mm = most ? std::sqrt(width * height / static_cast<double>(*most))
                                  : kDistanceOfSide * std::max(width, height);
  Segmentation best;
  for (const double share : kKernels) {
    Segmentation next;
    next.smoothing_mm = std::max(share * distance_mm, 0.5 * cell_mm);
    const double cells = next.smoothing_mm / cell_mm;
    const std::vector<double> kernel = gaussian_kernel(cells);
    next.height = convolved(convolved(grid.counts, kernel, {grid.rows, grid.columns, grid.columns, 1}),
                            kernel, {grid.columns, grid.rows, 1, grid.columns});
    const double highest = *std::max_element(next.height.begin(), next.height.end());
    // The squared kernel integrates to 1 / (4 pi s^2): the variance of a smoothed height.
    const double error_scale = 1.0 / (2.0 * std::sqrt(core::kPi) * cells);
    next.basins = find_basins(next.height, grid.rows, grid.columns, kFloor * highest, error_scale, most);
    if (next.basins.peaks.size() > best.basins.peaks.size()) best = std::move(next);
  }
  return best;
}

void set_peaks(FloodMap& map, const Basins& basins, const std::vector<double>& height) {
  for (const std::size_t cell : basins.peaks)
    map.peaks.push_back({middle_of(map.grid, cell), height[cell], 0, 0});
  map.peak_of_cell = basins.of_cell;
  for (std::size_t cell = 0; cell < map.peak_of_cell.size(); ++cell) {
    if (map.peak_of_cell[cell] != Basins::kNone) continue;
    const std::array<double, 2> here = middle_of(map.grid, cell);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < map.peaks.size(); ++i) {
      const double distance =
          std::hypot(map.peaks[i].position_mm[0] - here[0], map.peaks[i].position_mm[1] - here[1]);
      if (distance >= nearest) continue;
      nearest = distance;
      map.peak_of_cell[cell] = i;
    }
  }
  double sum = 0.0, worst = 0.0;
  for (const auto& [pair, saddle] : basins.saddles) {
    const double ratio = saddle / (0.5 * (map.peaks[pair.first].height + map.peaks[pair.second].height));
    map.neighbours.push_back({pair.first, pair.second, ratio});
    sum += ratio;
    worst = std::max(worst, ratio);
  }
  if (sum > 0.0) map.peak_to_valley = static_cast<double>(map.neighbours.size()) / sum;
  if (worst > 0.0) map.worst_peak_to_valley = 1.0 / worst;
}

void set_owners(FloodMap& map, std::span<const std::array<double, 2>> positions,
                std::span<const core::PartId> part) {
  for (const std::array<double, 2>& position : positions) ++map.peaks[map.peak_of(position)].events;
  if (part.empty()) return;
  map.crystals.assign(part.begin(), part.end());
  std::sort(map.crystals.begin(), map.crystals.end());
  map.crystals.erase(std::unique(map.crystals.begin(), map.crystals.end()), map.crystals.end());
  std::vector<std::map<std::size_t, std::uint64_t>> from(map.peaks.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto crystal = static_cast<std::size_t>(
        std::lower_bound(map.crystals.begin(), map.crystals.end(), part[i]) - map.crystals.begin());
    ++from[map.peak_of(positions[i])][crystal];
  }
  std::set<std::size_t> owners;
  std::uint64_t right = 0;
  for (std::size_t i = 0; i < map.peaks.size(); ++i) {
    std::uint64_t most = 0;
    for (const auto& [crystal, events] : from[i])
      if (events > most) {
        most = events;
        map.peaks[i].owner = crystal;
      }
    right += most;
    if (most > 0) owners.insert(map.peaks[i].owner);
  }
  map.share_right = core::binomial_estimate(right, positions.size());
  map.crystals_without_peak = map.crystals.size() - owners.size();
}

}  // namespace

std::size_t FloodGrid::cell(const std::array<double, 2>& position) const {
  const auto index = [](double value, double low, double high, std::size_t n) {
    const double at = (value - low) / (high - low) * static_cast<double>(n);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(n) - 1.0));
  };
  return index(position[1], y_low, y_high, rows) * columns + index(position[0], x_low, x_high, columns);
}

FloodMap flood_map(std::span<const std::array<double, 2>> positions, std::span<const core::PartId> part,
                   const FloodOptions& options) {
  if (!part.empty() && part.size() != positions.size())
    throw std::invalid_argument("positions and parts differ in number");
  if (positions.size() < kLeastPlaced)
    throw core::InputError(core::Problem{{},
                                         std::to_string(positions.size()) +
                                             " events with a position; a flood map needs " +
                                             std::to_string(kLeastPlaced),
                                         "simulate more events"});
  const std::optional<std::size_t> most = options.expected.value_or(0) > 0 ? options.expected : std::nullopt;
  FloodMap map;
  map.grid = grid_of(positions, options.cells);
  const Segmentation segmented = segment(map.grid, most);
  map.smoothing_mm = segmented.smoothing_mm;
  set_peaks(map, segmented.basins, segmented.height);
  set_owners(map, positions, part);
  return map;
}

}  // namespace scintray::analysis
