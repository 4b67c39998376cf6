#pragma once
/// The cells of a response map by light traced backward, and the tracer of that light.

#include <cstdint>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/simulation/response_map.hpp"
#include "scintray/tally/readout_channels.hpp"

namespace scintray::simulation {

/// Sums over photons that were started at one channel, for the cells of all grids of one medium.
struct ChannelLight {
  std::vector<double> sum, squares;    ///< of the photons' contributions to the probability, per cell
  std::vector<std::uint32_t> photons;  ///< that passed, per cell
  /// Times of flight (ns) per cell, ResponseMap::delays_kept each: every one drawn from all paths through the
  /// cell, with their contribution as weight.
  std::vector<float> delays_ns;

  /// Adds the light of other photons of the same channel.
  void add(const ChannelLight& other, std::uint32_t delays_kept, core::Rng& rng);
};

/// Traces light backward through the grids of one medium.
class BackwardTracer {
 public:
  /// @param grids  of regions of one medium; `photons` of a cell is 0 where it is empty
  /// @param volumes_mm3  of the region within each cell, one vector a grid
  BackwardTracer(const scene::Scene& scene, const tally::ReadoutChannels& channels, const ResponseMap& map,
                 std::vector<const ResponseGrid*> grids, std::vector<std::vector<double>> volumes_mm3,
                 const RunSettings& run);

  /// Light of photons first to last - 1 of a channel.
  /// @param stream  address of the channel's random streams
  ChannelLight trace(std::size_t channel, std::uint64_t stream, std::uint64_t first,
                     std::uint64_t last) const;
  std::size_t cells() const { return first_cell_.back(); }
  /// Number of the first cell of each of the grids, among the cells of all of them.
  const std::vector<std::size_t>& first_cells() const { return first_cell_; }

 private:
  friend class BackwardPhoton;
  /// A triangle through which light reaches a channel, on the boundary of the region that it enters.
  struct Window {
    core::RegionId region;
    std::uint32_t triangle = 0;
    double area_below_mm2 = 0.0;  ///< of the channel's triangles up to this one, itself included
  };
  void find_windows(const tally::ReadoutChannels& channels);

  const scene::Scene& scene_;
  const ResponseMap& map_;
  const RunSettings& run_;
  std::vector<core::SensorId> sensors_;       ///< per channel
  std::vector<std::vector<Window>> windows_;  ///< per channel
  std::vector<const ResponseGrid*> grids_;
  std::vector<std::vector<double>> volumes_mm3_;          ///< per grid and cell
  std::vector<std::size_t> first_cell_;                   ///< per grid, and the end
  core::IdVector<core::RegionId, std::int32_t> grid_of_;  ///< -1: none
  core::CurveSampler emission_;
};

/// Fills the empty grids of a map, whose settings, channels and photons_per_channel are set.
/// @return false when stopped
bool trace_backward(const scene::Scene& scene, const tally::ReadoutChannels& channels, const RunSettings& run,
                    const ResponseHooks& hooks, ResponseMap& map);

}  // namespace scintray::simulation
