#pragma once
/// Response maps: detection probabilities and delays of light from each position of a scene, traced once.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scintray/core/journal.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/core/words.hpp"
#include "scintray/simulation/run_point.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/tally/readout_channels.hpp"

namespace scintray::simulation {

/// Grid of equal cells over the bounding box of one part that scintillates, along the axes of the world.
/// Cells outside the part's region are empty.
struct ResponseGrid {
  std::string part;
  core::RegionId region;                  ///< that of the part
  core::Vec3 low = core::Vec3::Zero();    ///< corner of the box, mm
  core::Vec3 pitch = core::Vec3::Ones();  ///< edges of a cell, mm
  std::array<std::uint32_t, 3> cells{};
  std::vector<std::uint32_t> photons;   ///< emitted, per cell; 0: the cell is empty. z varies fastest
  std::vector<std::uint32_t> detected;  ///< of them, per cell and channel, channels fastest
  /// Of a map traced backward: detection probabilities and their standard errors, in the order of `detected`.
  /// There `photons` of a cell that is not empty are those started at all channels, and `detected` those of
  /// one channel that passed the cell. Empty in a map traced forward, whose probabilities are the ratios.
  std::vector<float> probabilities, probability_errors;
  /// Times from emission to detection, ns, of the first detected photons of each cell and channel, as many
  /// as ResponseMap::kept states: one after the other in the order of `detected`.
  std::vector<float> delays_ns;

  std::size_t size() const { return std::size_t{cells[0]} * cells[1] * cells[2]; }
  /// Detection probability of entry `response` of `detected`, of a cell that is not empty.
  double probability(std::size_t cell, std::size_t response) const {
    if (!probabilities.empty()) return double{probabilities[response]};
    return static_cast<double>(detected[response]) / static_cast<double>(photons[cell]);
  }
  /// The same with its standard error; binomial for a map traced forward.
  core::Estimate estimate(std::size_t cell, std::size_t response) const;
};

/// The box of a cell of a grid, mm.
Eigen::AlignedBox3d cell_box(const ResponseGrid& grid, std::size_t cell);

/// Detection of light from each cell by each channel, with times. Light starts uniform over the part of the
/// region within the cell, in all directions, with the emission spectrum of its medium.
struct ResponseMap {
  std::vector<std::string> channels;  ///< names, in the order of ReadoutChannels
  std::uint64_t seed = 1;
  std::uint32_t photons_per_cell = 0;     ///< of a map traced forward, else 0
  std::uint64_t photons_per_channel = 0;  ///< of a map traced backward, else 0
  std::uint32_t delays_kept = 0;          ///< most delays kept of one cell and channel
  bool unpolarised = false;               ///< light is emitted unpolarised
  std::vector<ResponseGrid> grids;

  bool backward() const { return photons_per_channel > 0; }
  /// Of a map traced backward: photons started at all channels, below 2^32.
  std::uint32_t photons_started() const {
    return static_cast<std::uint32_t>(photons_per_channel * channels.size());
  }
  /// Number of delays kept of `detected` photons.
  std::uint32_t kept(std::uint32_t detected) const { return std::min(detected, delays_kept); }
};

/// Direction in which the light of a map is traced.
enum class MapDirection {
  forward,    ///< from every cell
  backward,   ///< from every channel, against the direction of the light; an error where not exact
  automatic,  ///< backward where that is exact, else forward
};

/// Words of MapDirection.
inline constexpr core::Word<MapDirection> kMapDirections[] = {{"automatic", MapDirection::automatic},
                                                              {"forward", MapDirection::forward},
                                                              {"backward", MapDirection::backward}};

/// Resolution and statistics of a map.
struct ResponseSettings {
  double pitch_mm = 1.0;                    ///< largest edge of a cell: the box is divided into equal cells
  std::uint32_t photons_per_cell = 10'000;  ///< traced forward
  std::uint32_t delays_kept = 64;
  MapDirection direction = MapDirection::forward;
  std::uint64_t photons_per_channel = 200'000;  ///< traced backward, for each medium that scintillates
};

/// Limits of the cells times channels of a map, and of its delays: 1.6 and 2 GB in memory.
inline constexpr std::uint64_t kMostResponses = 400'000'000, kMostDelays = 500'000'000;

class MapShardWriter;

/// Progress, interruption and resumption of the construction, and a shard of it. Any may be empty.
struct ResponseHooks {
  std::function<void(std::uint64_t cells, std::uint64_t of)> progress;  ///< from one thread at a time
  const std::atomic<bool>* stop = nullptr;                              ///< set from outside: stop
  core::Journal* journal = nullptr;  ///< of this very map: its cells are taken from there, others added
  MapShardWriter* shard = nullptr;   ///< its pieces alone are traced, and added there
};

/// Response map by tracing the light of every cell, or that of every channel backward. The result does not
/// depend on the number of threads: every photon has its own random stream, of StreamKind::cell.
/// @param regions      scintillating regions, one grid each
/// @param unpolarised  light is emitted unpolarised
/// @param run          seed, threads and limits; a photon cut by a limit is not detected
/// @return a map without grids when stopped; of a shard, grids without their counts
/// @throws InputError when there is no sensor, no region scintillates, or the map would exceed
///         kMostResponses or kMostDelays; for MapDirection::backward when why_not_backward() has a reason
ResponseMap build_response_map(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                               bool unpolarised, const ResponseSettings& settings, const RunSettings& run,
                               const ResponseHooks& hooks = {});

/// Why the light of a scene cannot be traced backward exactly: the first surface, medium or sensor that is
/// not reciprocal. Empty: it can.
std::string why_not_backward(const scene::Scene& scene);

/// Empty grids as of build_response_map, one a region. @throws InputError as build_response_map
std::vector<ResponseGrid> lay_grids(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                                    double pitch_mm);

}  // namespace scintray::simulation
