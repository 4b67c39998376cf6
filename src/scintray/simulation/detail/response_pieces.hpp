#pragma once
/// The pieces of which a response map consists, and their assembly in a fixed order: whoever computed them,
/// the map has the same bits.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/simulation/response_map.hpp"

namespace scintray::simulation {

/// Light of one cell: a piece of a map traced forward.
struct CellResponse {
  std::uint32_t photons = 0;
  std::vector<std::uint32_t> detected;        ///< per channel
  std::vector<std::vector<float>> delays_ns;  ///< per channel
};

/// Sums over photons that were started at one channel, for the cells of all grids of one medium: a piece of a
/// map traced backward.
struct ChannelLight {
  std::vector<double> sum, squares;    ///< of the photons' contributions to the probability, per cell
  std::vector<std::uint32_t> photons;  ///< that passed, per cell
  /// Times of flight (ns) per cell, ResponseMap::delays_kept each: every one drawn from all paths through the
  /// cell, with their contribution as weight.
  std::vector<float> delays_ns;

  /// Adds the light of other photons of the same channel.
  void add(const ChannelLight& other, std::uint32_t delays_kept, core::Rng& rng);
};

/// Moves the cells of a map traced forward into its grids, which have no counts before.
class CellAssembly {
 public:
  explicit CellAssembly(ResponseMap& map);

  /// A cell of a grid.
  struct Place {
    std::size_t grid = 0, cell = 0;
  };

  std::uint64_t pieces() const { return first_.back(); }
  Place place(std::uint64_t piece) const;
  /// Key of a piece in a journal.
  static std::string key(std::uint64_t piece);
  /// Adds the next piece; they are added in their order.
  void add(std::uint64_t piece, const CellResponse& response);
  /// True for a piece as the map may have it.
  bool is_consistent(const CellResponse& response) const;

 private:
  ResponseMap& map_;
  std::vector<std::uint64_t> first_;  ///< piece of the first cell of each grid, and the end
};

/// Moves the light of the channels of a map traced backward into its grids, which have `photons` before.
class ChannelAssembly {
 public:
  /// @param media  of each grid: number of its medium, from 0, without gaps
  ChannelAssembly(ResponseMap& map, const std::vector<std::uint32_t>& media);

  /// Photons of a channel with the spectrum of a medium.
  struct Place {
    std::size_t medium = 0, channel = 0;
    std::uint64_t part = 0, parts = 1;  ///< of the photons of the channel
    std::uint64_t stream = 0;           ///< address of the channel's random streams
  };

  std::uint64_t pieces() const { return first_.back(); }
  std::size_t media() const { return grids_.size(); }
  const std::vector<ResponseGrid*>& grids_of(std::size_t medium) const { return grids_[medium]; }
  Place place(std::uint64_t piece) const;
  /// Key of a piece in a journal; longer than those of cells.
  std::string key(std::uint64_t piece) const;
  /// Adds the next piece; they are added in their order.
  void add(std::uint64_t piece, ChannelLight& light);
  /// True for a piece as the map may have it.
  bool is_consistent(std::uint64_t piece, const ChannelLight& light) const;

 private:
  std::size_t cells_of(std::size_t medium) const;
  std::uint64_t parts_of(std::size_t medium) const;
  void fill(std::size_t medium);

  ResponseMap& map_;
  std::vector<std::vector<ResponseGrid*>> grids_;  ///< per medium
  std::vector<std::uint64_t> first_;               ///< first piece of each medium, and the end
  std::vector<ChannelLight> lights_;               ///< per channel, of the present medium
};

/// Throws InputError where a map would be too large for memory, or would count more photons than it can.
void refuse_too_large(const ResponseMap& map);

}  // namespace scintray::simulation
