#pragma once
/// Which cell of a silicon photomultiplier is where.

#include <array>
#include <cstdint>
#include <span>

#include "scintray/core/philox.hpp"
#include "scintray/detector/avalanche.hpp"
#include "scintray/detector/sensor_data.hpp"

namespace scintray::detector {

/// Square cells in rows from the corner of least x and y; the last row may be short when the number of
/// cells is given.
class MicrocellGrid {
 public:
  /// Throws InputError when the face has no area or holds no cell or more than 10^8.
  MicrocellGrid(const Microcells& cells, const SensorFace& face);

  std::uint32_t count() const { return count_; }
  /// The cell at a place; beyond the edges the nearest one. Any cell when the place is not known.
  std::uint32_t at(const Arrival& arrival, core::Rng& rng) const;
  std::uint32_t any(core::Rng& rng) const;
  /// The up to eight cells around one, written to `buffer`.
  std::span<const std::uint32_t> neighbours(std::uint32_t cell, std::array<std::uint32_t, 8>& buffer) const;

 private:
  SensorFace face_;
  std::uint32_t columns_ = 1, rows_ = 1, count_ = 1;
};

}  // namespace scintray::detector
