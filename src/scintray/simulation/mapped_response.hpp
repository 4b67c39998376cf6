#pragma once
/// Interpolation of a response map: detection of light from any position.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/optics/decay_time.hpp"
#include "scintray/simulation/response_map.hpp"

namespace scintray::simulation {

/// Response of one channel to light from one position. Cheap to copy; the MappedResponse must outlive it.
class PlaceResponse {
 public:
  /// Detection probability of a photon emitted there.
  double probability() const { return probability_; }
  /// Delay from emission to detection of a detected photon, ns: one of those in the map, from a nearby cell.
  double sample_delay(core::Rng& rng) const;
  /// The shortest delay, ns.
  double earliest_delay() const { return earliest_; }

 private:
  friend class MappedResponse;
  struct Cell {
    double below = 0.0;  ///< probability of the cells before this one, and of it
    std::span<const float> delays_ns;
  };
  double probability_ = 0.0;
  double earliest_ = std::numeric_limits<double>::infinity();
  std::size_t count_ = 0;
  std::array<Cell, 8> cells_;
};

/// Interpolation of a map: probabilities linear in x, y and z between the centres of cells, constant beyond
/// the outermost centres; empty cells are left out of the mean. Where all neighbours are empty, the nearest
/// cell that is not empty is used. Immutable; keeps a reference to the map.
class MappedResponse {
 public:
  explicit MappedResponse(const ResponseMap& map);

  std::size_t channels() const { return map_.channels.size(); }
  /// True when light from this region is in the map.
  bool covers(core::RegionId region) const {
    return grid_of_.contains(region) && grid_of_[region].has_value();
  }
  /// Response of every channel, in order, to light from a position in a covered region.
  /// @param response  one a channel
  void at(const core::Vec3& position, core::RegionId region, std::vector<PlaceResponse>& response) const;

 private:
  struct Grid {
    const ResponseGrid* data = nullptr;
    std::vector<std::uint64_t> first_delay;  ///< of each cell
    std::vector<float> earliest;             ///< delay of each cell and channel; 0 without any
  };
  using GridId = core::Id<Grid>;
  struct Corner {
    std::size_t cell = 0;
    double weight = 0.0;
  };
  struct Corners {
    std::array<Corner, 8> list;
    std::size_t count = 0;
  };
  static Corners corners(const ResponseGrid& grid, const core::Vec3& position);
  static std::size_t nearest_filled(const ResponseGrid& grid, const core::Vec3& position);

  const ResponseMap& map_;
  core::IdVector<GridId, Grid> grids_;
  core::IdVector<core::RegionId, GridId> grid_of_;
};

/// Time of the first of `count` photons (at least 1) that a channel detects of light excited at time 0 with
/// these decay times. Photons are generated in the order of their decay, whose steps are those of ordered
/// exponentials (A. Renyi 1953, Acta Math. Acad. Sci. Hung. 4, 191), up to the one that is too late to be
/// first even with the shortest delay: exact, and fast where times of flight are short compared with the
/// decay time.
double sample_first(std::uint64_t count, const std::vector<optics::DecayComponent>& decay,
                    const PlaceResponse& response, core::Rng& rng);

}  // namespace scintray::simulation
