#pragma once
/// Directions from a surface table, for one photon and for several in lanes. Laws are templates over a number
/// type (core/number.hpp), also where they take one photon's numbers alone, so that nothing that is compiled
/// for lanes can stand for others.

#include <cstddef>
#include <cstdint>

#include "scintray/core/number.hpp"

namespace scintray::optics {

using core::root;
using core::select;

/// The interval between two nodes of a table. Positions are in a measure of the incidence angle that needs no
/// arc function, sin / (sin + cos), and `bend` corrects the relative position in this measure to that in
/// angle: by bend x (1 - x). For nodes 2.25 deg apart the error is 5e-5 of the interval.
struct alignas(64) TableInterval {
  double start = 0.0;  ///< of the lower node
  double per_length = 0.0;
  double bend = 0.0;
  double reflectance = 0.0, reflectance_step = 0.0;
  double absorptance = 0.0, absorptance_step = 0.0;
  /// Nodes whose directions are used, counted from the lower: a node without light on that side has no
  /// distribution. Transmitted, reflected.
  std::uint8_t low[2] = {0, 0}, high[2] = {1, 1};
  bool transmits = false;  ///< transmittance above 0 at one of its nodes
};

/// Sine of incidence below which the plane of incidence is drawn at random.
inline constexpr double kNoPlane = 1e-9;
/// Smallest cosine of exit: a direction exactly in the surface would be on neither side.
inline constexpr double kLeastCosine = 1e-7;

/// The numbers of a table's sampler (table_sampler.hpp) for incidence from one side.
struct TableView {
  static constexpr std::uint32_t kLookupSteps = 2048;
  static constexpr int kPolarBins = 64, kAzimuthBins = 32;
  static constexpr std::size_t kRowEnds = kAzimuthBins + 1;

  const TableInterval* intervals = nullptr;
  const std::uint32_t* lookup = nullptr;  ///< first candidate interval for equal steps of the measure
  std::size_t nodes = 0;
  // Of light transmitted and reflected:
  const float* polar[2] = {nullptr, nullptr};            ///< [polar edge][node], rad
  const std::uint16_t* azimuth[2] = {nullptr, nullptr};  ///< [polar bin][node][azimuth edge]
  float azimuth_zero = 0.0f, azimuth_step = 0.0f;        ///< coding of azimuths
  bool folded = true;    ///< azimuths are those to either side of the plane of incidence
  bool absorbs = false;  ///< the table has an absorptance above 0
};

/// Direction of exit from a table: polar angle and azimuth, rad.
struct TableExit {
  float polar = 0.0f, azimuth = 0.0f;
};

/// Level s of a cumulative probability u with P = 2 s^2 below the median and, mirrored, 1 - 2 (1 - s)^2 above.
template <typename Real>
Real level_of_two_tails(const Real& u) {
  const core::MaskOf<Real> low = u < Real(0.5);
  const Real level = root(Real(0.5) * select(low, u, Real(1.0) - u));
  return select(low, level, Real(1.0) - level);
}
/// Level s with P = 1 - (1 - s)^2.
template <typename Real>
Real level_of_one_tail(const Real& u) {
  return Real(1.0) - root(Real(1.0) - u);
}

/// A measure of the incidence angle between 0 and 1, increasing with it, that needs no arc function.
template <typename Real>
Real slant_of(const Real& sine, const Real& cosine) {
  return sine / (sine + cosine);
}

/// Position of an incidence angle between two nodes, and the shares there, linear between them. For one photon.
/// @tparam Real  a number type, whose photons' place it is
template <typename Real>
struct TablePlace {
  const TableInterval* interval;
  double share;  ///< relative position towards the next node, in [0, 1]

  TablePlace(const TableView& table, double slant) {
    constexpr double kSteps = TableView::kLookupSteps;
    const double step = slant * kSteps;
    std::size_t k = table.lookup[step < kSteps ? static_cast<std::uint32_t>(step) : TableView::kLookupSteps];
    while (k + 2 < table.nodes && slant >= table.intervals[k + 1].start) ++k;
    interval = table.intervals + k;
    const double along = (slant - interval->start) * interval->per_length;
    const double x = along < 0.0 ? 0.0 : 1.0 < along ? 1.0 : along;
    share = x + interval->bend * x * (1.0 - x);
  }
  double reflectance() const { return interval->reflectance + share * interval->reflectance_step; }
  double absorptance() const { return interval->absorptance + share * interval->absorptance_step; }
  bool transmits() const { return interval->transmits; }

  /// Direction of exit.
  /// @param s     level of the polar angle; @param t of the azimuth
  /// @param side  of the plane of incidence, for folded azimuths: 1: the negative one
  TableExit exit(const TableView& table, bool reflected, double s, double t, bool side) const {
    constexpr int kPolar = TableView::kPolarBins, kAzimuth = TableView::kAzimuthBins;
    const int polar_step = static_cast<int>(s * kPolar), azimuth_step = static_cast<int>(t * kAzimuth);
    const int polar_bin = polar_step < kPolar - 1 ? polar_step : kPolar - 1;
    const int azimuth_bin = azimuth_step < kAzimuth - 1 ? azimuth_step : kAzimuth - 1;
    const auto polar_part = static_cast<float>(s * kPolar - polar_bin);
    const auto azimuth_part = static_cast<float>(t * kAzimuth - azimuth_bin);
    const auto towards = static_cast<float>(share);
    const std::size_t way = reflected ? 1 : 0;
    const auto node = static_cast<std::size_t>(interval - table.intervals);
    const std::size_t row = static_cast<std::size_t>(polar_bin) * table.nodes + node;
    const auto angles = [&](std::size_t at) -> TableExit {
      const float* polar = table.polar[way] + at;
      const std::uint16_t* azimuth =
          table.azimuth[way] + at * TableView::kRowEnds + static_cast<std::size_t>(azimuth_bin);
      const auto low = static_cast<float>(azimuth[0]), high = static_cast<float>(azimuth[1]);
      return {polar[0] + polar_part * (polar[table.nodes] - polar[0]), low + azimuth_part * (high - low)};
    };
    const TableExit a = angles(row + interval->low[way]), b = angles(row + interval->high[way]);
    const float azimuth =
        table.azimuth_step * (a.azimuth + towards * (b.azimuth - a.azimuth) - table.azimuth_zero);
    return {a.polar + towards * (b.polar - a.polar), table.folded && side ? -azimuth : azimuth};
  }
};

}  // namespace scintray::optics
