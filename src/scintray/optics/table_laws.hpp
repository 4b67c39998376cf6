#pragma once
/// Interactions with a surface table, over a number type (core/number.hpp): what is computed, and for each
/// photon alone what is looked up. Plain data, so that it may be compiled for instruction sets that not every
/// processor has.

#include <cstddef>
#include <cstdint>
#include <numbers>

#include "scintray/core/number.hpp"
#include "scintray/optics/table_bins.hpp"

namespace scintray::optics {

using core::least;
using core::root;
using core::select;
using core::whole_part;

/// Sine of the incidence angle below which there is no plane of incidence: one is drawn.
inline constexpr double kNoIncidencePlane = 1e-9;
/// A direction exactly in the surface would be on neither side: least cosine to the normal.
inline constexpr double kLeastExitCosine = 1e-7;

/// The interval between two nodes. Positions are in a measure of the incidence angle that needs no arc
/// function (slant_of), and `bend` corrects the relative position in this measure to that in angle: by bend x
/// (1 - x). For nodes 2.25 deg apart the error is 5e-5 of the interval.
struct alignas(64) TableInterval {
  double start = 0.0;  ///< of the lower node
  double per_length = 0.0;
  double bend = 0.0;
  double reflectance = 0.0;

  double reflectance_step = 0.0;
  /// 2 in an interval that transmits nothing, as rounding must not transmit light where no node does, and -2
  /// in a table that absorbs nothing.
  double absorptance = 0.0, absorptance_step = 0.0;
  double first_row = 0.0;  ///< of its quantiles, of the first polar edge
};
static_assert(sizeof(TableInterval) == 64);

/// Polar edges of an interval: rows of its quantiles.
inline constexpr int kPolarRows = kPolarBins + 1;
/// Azimuth edges of a row.
inline constexpr int kAzimuthEdges = kAzimuthBins + 1;

/// The numbers of a TableSampler. Quantiles are those at the lower and the higher node of an interval, one
/// beside the other: where one has none, as it sends no light to that side, those of the other.
struct TableView {
  const TableInterval* intervals = nullptr;
  const std::uint32_t* lookup = nullptr;  ///< first candidate interval for equal steps of slant_of()
  std::uint32_t interval_count = 0;
  std::uint32_t folded = 1;   ///< 1: azimuths are from 0 to pi
  double azimuth_zero = 0.0;  ///< of the 16-bit codes
  // Transmitted, reflected.
  const float* polar[2] = {};            ///< [row][node], rad
  const std::uint16_t* azimuth[2] = {};  ///< [row][azimuth edge][node]
};
static_assert(sizeof(TableView) == 64);

/// Number of steps of the lookup: finer than the nodes, so that at most one or two steps remain.
inline constexpr std::uint32_t kTableLookupSteps = 2048;

/// A measure of the incidence angle between 0 and 1, increasing with it.
template <typename Real>
Real slant_of(const Real& sine, const Real& cosine) {
  return sine / (sine + cosine);
}

/// The step of the lookup at a slant: a whole number.
template <typename Real>
Real lookup_step(const Real& slant) {
  constexpr double kSteps = kTableLookupSteps;
  return least(whole_part(slant * Real(kSteps)), Real(kSteps));
}
/// @param step  lookup_step(slant)
[[gnu::always_inline]] inline const TableInterval& interval_at(const TableView& table, double slant,
                                                               std::uint32_t step) {
  std::uint32_t k = table.lookup[step];
  while (k + 1 < table.interval_count && slant >= table.intervals[k + 1].start) ++k;
  return table.intervals[k];
}

/// Relative position of a slant within an interval, from 0 to 1.
template <typename Real>
Real share_of(const Real& slant, const Real& start, const Real& per_length, const Real& bend) {
  const Real zero(0.0), one(1.0), along = (slant - start) * per_length;
  const Real x = select(along < zero, zero, select(one < along, one, along));
  return x + bend * x * (one - x);
}

/// Position among the quantiles at polar_level(), or signed_azimuth_level(), of a uniform number: from 0
/// to 1.
template <typename Real>
Real level_of_two_tails(const Real& u) {
  const Real half(0.5), one(1.0);
  const auto low = u < half;
  const Real level = root(half * select(low, u, one - u));
  return select(low, level, one - level);
}
/// Likewise for azimuth_level().
template <typename Real>
Real level_of_one_tail(const Real& u) {
  return Real(1.0) - root(Real(1.0) - u);
}

/// A level between 0 and 1 among equal bins.
template <typename Real>
struct TableBin {
  Real number;  ///< a whole number
  Real part;    ///< position within the bin

  TableBin(const Real& level, int bins) : TableBin(level * Real(bins), Real(bins - 1)) {}

 private:
  TableBin(const Real& at, const Real& last) : number(least(whole_part(at), last)), part(at - number) {}
};

/// Quantiles at the lower and the higher edge of a bin, each at the lower and the higher node.
template <typename Real>
struct TableQuantiles {
  Real low[2], high[2];

  /// Interpolated between edges, and between nodes.
  /// @param part   TableBin::part
  /// @param share  of share_of()
  Real at(const Real& part, const Real& share) const {
    const Real first = low[0] + part * (high[0] - low[0]), second = low[1] + part * (high[1] - low[1]);
    return first + share * (second - first);
  }
};

/// Codes of azimuth quantiles, as they follow each other in memory, as numbers.
template <typename Real>
TableQuantiles<Real> azimuth_codes(const core::BitsOf<Real>& four) {
  const core::BitsOf<Real> mask(0xffffULL);
  return {{core::value_of<Real>(four & mask), core::value_of<Real>((four >> 16) & mask)},
          {core::value_of<Real>((four >> 32) & mask), core::value_of<Real>(four >> 48)}};
}
/// A step of these codes, rad.
inline constexpr double azimuth_step_rad(bool folded) {
  return std::numbers::pi / (folded ? 65535.0 : 32767.0);
}

}  // namespace scintray::optics
