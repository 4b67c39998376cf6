#pragma once
/// Interactions with a surface table, over a number type (core/number.hpp): what is computed, and for each
/// photon alone what is looked up. Plain data, so that it may be compiled for instruction sets that not every
/// processor has.

#include <cstddef>
#include <cstdint>

#include "scintray/core/number.hpp"
#include "scintray/optics/table_bins.hpp"

namespace scintray::optics {

using core::root;
using core::select;

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
  double absorptance = 0.0, absorptance_step = 0.0;
  /// Nodes whose directions are used, counted from the lower: a node without light on that side has no
  /// distribution. Transmitted, reflected.
  std::uint8_t low[2] = {0, 0}, high[2] = {1, 1};
  bool transmits = false;  ///< transmittance above 0 at one of its nodes
};
static_assert(sizeof(TableInterval) == 64);

/// The numbers of a TableSampler.
struct TableView {
  const TableInterval* intervals = nullptr;
  const std::uint32_t* lookup = nullptr;  ///< first candidate interval for equal steps of slant_of()
  std::uint32_t interval_count = 0, nodes = 0;
  float azimuth_zero = 0.0f, azimuth_step = 0.0f;  ///< of the 16-bit codes, rad
  bool folded = true;                              ///< azimuths are from 0 to pi
  // Transmitted, reflected.
  const float* polar[2] = {};            ///< [polar edge][node], rad
  const std::uint16_t* azimuth[2] = {};  ///< [polar bin][node][azimuth edge]
};

/// Number of steps of the lookup: finer than the nodes, so that at most one or two steps remain.
inline constexpr std::uint32_t kTableLookupSteps = 2048;

/// A measure of the incidence angle between 0 and 1, increasing with it.
template <typename Real>
Real slant_of(const Real& sine, const Real& cosine) {
  return sine / (sine + cosine);
}

[[gnu::always_inline]] inline const TableInterval& interval_at(const TableView& table, double slant) {
  const auto step = static_cast<std::uint32_t>(slant * kTableLookupSteps);
  std::uint32_t k = table.lookup[step < kTableLookupSteps ? step : kTableLookupSteps];
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

/// Polar angle and azimuth of exit, rad.
struct TableExit {
  float polar, azimuth;
};

/// Where the quantiles of an exit are. Known before they are read, so that those of several photons can be
/// fetched at once.
struct TableCell {
  const float *polar_low, *polar_high;  ///< at the lower and the higher node
  const std::uint16_t *azimuth_low, *azimuth_high;
  float polar_part, azimuth_part;  ///< position within the bins
};

/// @param way    0: transmitted, 1: reflected
/// @param polar_level, azimuth_level  from 0 to 1
[[gnu::always_inline]] inline TableCell table_cell(const TableView& table, const TableInterval& interval,
                                                   int way, double polar_level, double azimuth_level) {
  constexpr std::size_t kRowEnds = kAzimuthBins + 1;
  const double polar_at = polar_level * kPolarBins, azimuth_at = azimuth_level * kAzimuthBins;
  int polar_bin = static_cast<int>(polar_at), azimuth_bin = static_cast<int>(azimuth_at);
  if (polar_bin > kPolarBins - 1) polar_bin = kPolarBins - 1;
  if (azimuth_bin > kAzimuthBins - 1) azimuth_bin = kAzimuthBins - 1;
  const auto node = static_cast<std::size_t>(&interval - table.intervals);
  const std::size_t row = static_cast<std::size_t>(polar_bin) * table.nodes + node;
  const std::size_t low = row + interval.low[way], high = row + interval.high[way];
  const std::uint16_t* const azimuth = table.azimuth[way] + static_cast<std::size_t>(azimuth_bin);
  return {table.polar[way] + low,
          table.polar[way] + high,
          azimuth + low * kRowEnds,
          azimuth + high * kRowEnds,
          static_cast<float>(polar_at - polar_bin),
          static_cast<float>(azimuth_at - azimuth_bin)};
}

/// Interpolated between quantiles, and between the nodes of an interval.
/// @param share  of share_of()
[[gnu::always_inline]] inline TableExit table_exit(const TableView& table, const TableCell& at,
                                                   double share) {
  const auto part = static_cast<float>(share);
  const float low_polar = at.polar_low[0] + at.polar_part * (at.polar_low[table.nodes] - at.polar_low[0]);
  const float high_polar = at.polar_high[0] + at.polar_part * (at.polar_high[table.nodes] - at.polar_high[0]);
  const auto low_first = static_cast<float>(at.azimuth_low[0]),
             low_second = static_cast<float>(at.azimuth_low[1]);
  const auto high_first = static_cast<float>(at.azimuth_high[0]),
             high_second = static_cast<float>(at.azimuth_high[1]);
  const float low_azimuth = low_first + at.azimuth_part * (low_second - low_first);
  const float high_azimuth = high_first + at.azimuth_part * (high_second - high_first);
  return {low_polar + part * (high_polar - low_polar),
          table.azimuth_step * (low_azimuth + part * (high_azimuth - low_azimuth) - table.azimuth_zero)};
}

}  // namespace scintray::optics
