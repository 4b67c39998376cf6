#pragma once
/// Flood maps: histograms of event positions, and the assignment of events to crystals.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scintray/core/ids.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

struct FloodGrid {
  std::size_t columns = 0, rows = 0;
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  std::vector<double> counts;  ///< rows x columns, the first row lowest

  /// Cell of a position, clamped to the grid.
  std::size_t cell(const std::array<double, 2>& position) const;
};

/// A peak of the map, which represents a crystal.
struct FloodPeak {
  std::array<double, 2> position_mm{};  ///< of the highest cell of the smoothed map
  double height = 0.0;                  ///< smoothed counts per cell
  std::uint64_t events = 0;             ///< assigned to it
  std::size_t owner = 0;                ///< index into FloodMap::crystals: origin of most of its events
};

/// Two adjacent peaks, and the saddle between them.
struct FloodNeighbours {
  std::size_t a = 0, b = 0;     ///< indices into FloodMap::peaks
  double valley_to_peak = 0.0;  ///< height of the saddle over the mean of the two peaks, 0 to 1
};

struct FloodOptions {
  std::size_t cells = 256;              ///< along the longer side
  std::optional<std::size_t> expected;  ///< number of crystals, when known: the limit of the peaks
};

struct FloodMap {
  FloodGrid grid;
  double smoothing_mm = 0.0;     ///< standard deviation of the kernel before segmentation
  std::vector<FloodPeak> peaks;  ///< highest first
  std::vector<FloodNeighbours> neighbours;
  std::vector<std::uint32_t> peak_of_cell;  ///< per cell of the grid
  std::vector<core::PartId> crystals;       ///< parts with an interaction in the events, rising
  /// Share of the events whose peak's owner is the part of the interaction; not a number without parts.
  core::Estimate share_right;
  std::size_t crystals_without_peak = 0;  ///< parts that own no peak
  /// Mean of peak over valley of the neighbours: the inverse of the mean valley-to-peak, so that one empty
  /// valley does not make it infinite. 0 without neighbours.
  double peak_to_valley = 0.0;
  double worst_peak_to_valley = 0.0;  ///< of the least separated neighbours

  std::uint32_t peak_of(const std::array<double, 2>& position) const {
    return peak_of_cell[grid.cell(position)];
  }
};

/// Flood map: histogram of the positions, smoothed with a Gaussian, then segmented from the top: cells join
/// the basin of the neighbour that is higher (watershed: L. Vincent and P. Soille 1991, IEEE Trans. Pattern
/// Anal. Mach. Intell. 13, 583), and where two basins touch the lower peak is removed unless it is 5
/// standard errors above the saddle (persistence: H. Edelsbrunner et al. 2002, Discrete Comput. Geom. 28,
/// 511). With `expected`, only the most significant ones are kept. Of kernels from 1/4 to 1/22 of the
/// distance of peaks (known from their number, else 8 % of the longer side) the widest that shows the most
/// peaks is used: light sharing compresses a map at its edges, which requires a narrow one, and few events a
/// wide one. Cells that are empty also after smoothing belong to the nearest peak.
/// @param part  part of the interaction of each event, in step with `positions`; empty when not known
/// @throws InputError with fewer than 100 events, or when they lie on one line
FloodMap flood_map(std::span<const std::array<double, 2>> positions, std::span<const core::PartId> part,
                   const FloodOptions& options = {});

}  // namespace scintray::analysis
