#pragma once
/// The cells of silicon photomultipliers.

#include <array>
#include <cstdint>
#include <span>

#include "scintray/detector/avalanche_model.hpp"

namespace scintray::detector {

/// The cells of a silicon photomultiplier. Exactly one of pitch and count is not 0.
struct Microcells {
  double pitch_mm = 0.0;
  std::uint32_t count = 0;   ///< of the whole sensor
  double recovery_ns = 0.0;  ///< time constant of the recharge, above 0
  double crosstalk = 0.0;    ///< probability that a full avalanche fires at least one neighbour at once
  double afterpulse = 0.0;   ///< probability that a full avalanche fires its own cell once more later
  double afterpulse_time_ns = 0.0;  ///< time constant of that delay
};

/// Silicon photomultipliers: every carrier fires its cell. The charge is 1 - exp(-dt / recovery), with dt the
/// time since the cell last fired. Each of the eight neighbours fires at once with the probability q for
/// which 1 - (1 - q)^8 is the crosstalk (L. Gallego et al. 2013, JINST 8, P05013), and so do their neighbours
/// in turn; cells at the edge have fewer. The cell fires once more after an exponential delay with the
/// afterpulse probability. In a cell that has not recovered both are reduced with its charge: 1 - q is raised
/// to the power of the charge, and the afterpulse probability is multiplied by it. An event begins with
/// recovered cells, except for dark counts of the time before.
class MicrocellModel : public AvalancheModel {
 public:
  explicit MicrocellModel(const Microcells& its_cells) : cells(its_cells) {}

  Microcells cells;

  /// Throws InputError when the face has no area or more cells than 10^8.
  std::unique_ptr<const AvalancheProcess> on(const SensorFace& face) const override;
};

/// Grid of square cells in rows from the corner of least x and y; the last row may be incomplete when the
/// number of cells is specified.
class MicrocellGrid {
 public:
  /// Throws InputError when the face has no area or holds no cell or more than 10^8.
  MicrocellGrid(const Microcells& cells, const SensorFace& face);

  std::uint32_t count() const { return count_; }
  /// Number of the cell at the position of an arrival; beyond the edges the nearest one, without a position
  /// any cell.
  std::uint32_t at(const Arrival& arrival, core::Rng& rng) const;
  std::uint32_t any(core::Rng& rng) const;
  /// The up to eight cells around one, written to `buffer`.
  std::span<const std::uint32_t> neighbours(std::uint32_t cell, std::array<std::uint32_t, 8>& buffer) const;

 private:
  SensorFace face_;
  std::uint32_t columns_ = 1, rows_ = 1, count_ = 1;
};

}  // namespace scintray::detector
