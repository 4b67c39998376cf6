#pragma once
/// The cells of a response map by light traced backward, and the tracer of that light.

#include <cstdint>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/simulation/detail/response_pieces.hpp"
#include "scintray/simulation/response_map.hpp"
#include "scintray/tally/readout_channels.hpp"

namespace scintray::simulation {

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

/// Fills the empty grids of a map, whose settings, channels and photons_per_channel are set, or a shard of
/// it.
/// @return false when stopped
bool trace_backward(const scene::Scene& scene, const tally::ReadoutChannels& channels, const RunSettings& run,
                    const ResponseHooks& hooks, ResponseMap& map);

}  // namespace scintray::simulation
