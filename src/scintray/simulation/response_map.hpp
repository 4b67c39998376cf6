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
  /// Times from emission to detection, ns, of the first detected photons of each cell and channel, as many
  /// as ResponseMap::kept states: one after the other in the order of `detected`.
  std::vector<float> delays_ns;

  std::size_t size() const { return std::size_t{cells[0]} * cells[1] * cells[2]; }
};

/// Detection of light from each cell by each channel, with times. Light starts uniform over the part of the
/// region within the cell, in all directions, with the emission spectrum of its medium.
struct ResponseMap {
  std::vector<std::string> channels;  ///< names, in the order of ReadoutChannels
  std::uint64_t seed = 1;
  std::uint32_t photons_per_cell = 0;
  std::uint32_t delays_kept = 0;  ///< most delays kept of one cell and channel
  bool unpolarised = false;       ///< light is emitted unpolarised
  std::vector<ResponseGrid> grids;

  /// Number of delays kept of `detected` photons.
  std::uint32_t kept(std::uint32_t detected) const { return std::min(detected, delays_kept); }
};

/// Resolution and statistics of a map.
struct ResponseSettings {
  double pitch_mm = 1.0;  ///< largest edge of a cell: edges divide those of the box evenly
  std::uint32_t photons_per_cell = 10'000;
  std::uint32_t delays_kept = 64;
};

/// Limits of the cells times channels of a map, and of its delays: 1.6 and 2 GB in memory.
inline constexpr std::uint64_t kMostResponses = 400'000'000, kMostDelays = 500'000'000;

/// Progress, interruption and resumption of the construction. Any may be empty.
struct ResponseHooks {
  std::function<void(std::uint64_t cells, std::uint64_t of)> progress;  ///< from one thread at a time
  const std::atomic<bool>* stop = nullptr;                              ///< set from outside: stop
  core::Journal* journal = nullptr;  ///< of this very map: its cells are taken from there, others added
};

/// Response map by tracing the light of every cell. The result does not depend on the number of threads:
/// every photon has its own random stream, of StreamKind::cell.
/// @param regions      scintillating regions, one grid each
/// @param unpolarised  light is emitted unpolarised
/// @param run          seed, threads and limits; a photon cut by a limit is not detected
/// @return a map without grids when stopped
/// @throws InputError when there is no sensor, no region scintillates, or the map would exceed
///         kMostResponses or kMostDelays
ResponseMap build_response_map(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                               bool unpolarised, const ResponseSettings& settings, const RunSettings& run,
                               const ResponseHooks& hooks = {});

/// Empty grids as of build_response_map, one a region. @throws InputError as build_response_map
std::vector<ResponseGrid> lay_grids(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                                    double pitch_mm);

}  // namespace scintray::simulation
