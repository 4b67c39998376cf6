#include "scintray/cli/response_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iostream>

namespace scintray::cli {

namespace {

/// Sums over the cells of a grid.
struct GridTotals {
  std::uint64_t filled = 0;  ///< cells that are not empty
  double detected = 0.0;     ///< mean probability of detection by any channel
  double variance = 0.0;     ///< mean variance of the probability of one channel
};

GridTotals totals_of(const simulation::ResponseGrid& grid) {
  GridTotals totals;
  const std::size_t channels = grid.detected.size() / grid.photons.size();
  for (std::size_t cell = 0; cell < grid.photons.size(); ++cell) {
    if (grid.photons[cell] == 0) continue;
    ++totals.filled;
    for (std::size_t i = cell * channels; i < (cell + 1) * channels; ++i) {
      const core::Estimate estimate = grid.estimate(cell, i);
      totals.detected += estimate.value;
      totals.variance += estimate.error * estimate.error;
    }
  }
  totals.detected /= static_cast<double>(totals.filled);
  totals.variance /= static_cast<double>(totals.filled * channels);
  return totals;
}

}  // namespace

Json json_of_map(const simulation::ResponseMap& map) {
  Json grids = Json::array();
  for (const simulation::ResponseGrid& grid : map.grids) {
    const GridTotals totals = totals_of(grid);
    grids.push_back({{"part", grid.part},
                     {"cells", {grid.cells[0], grid.cells[1], grid.cells[2]}},
                     {"pitch_mm", {grid.pitch.x(), grid.pitch.y(), grid.pitch.z()}},
                     {"cells_filled", totals.filled},
                     {"detected_fraction", totals.detected},
                     {"rms_probability_error", std::sqrt(totals.variance)}});
  }
  return {{"direction", map.backward() ? "backward" : "forward"},
          {"photons_per_cell", map.photons_per_cell},
          {"photons_per_channel", map.photons_per_channel},
          {"grids", grids}};
}

void print_map(const simulation::ResponseMap& map) {
  std::cout << (map.backward()
                    ? fmt::format("traced backward, {} photons from each of {} channels\n",
                                  map.photons_per_channel, map.channels.size())
                    : fmt::format("traced forward, {} photons from each cell\n", map.photons_per_cell));
  for (const simulation::ResponseGrid& grid : map.grids) {
    const auto [filled, detected, variance] = totals_of(grid);
    std::cout << fmt::format(
        "{}: {} x {} x {} cells of {:.4g} x {:.4g} x {:.4g} mm, {} of them filled; detected {:.4f}, standard "
        "error of one channel's probability {:.2g}\n",
        grid.part, grid.cells[0], grid.cells[1], grid.cells[2], grid.pitch.x(), grid.pitch.y(),
        grid.pitch.z(), filled, detected, std::sqrt(variance));
  }
}

}  // namespace scintray::cli
