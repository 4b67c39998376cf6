#pragma once
/// Lengths and directions of a height map, from its autocorrelation and its power spectrum.

#include <optional>
#include <string>
#include <vector>

#include "scintray/topography/height_map.hpp"
#include "scintray/topography/map_statistics.hpp"

namespace scintray::topography {

/// The autocorrelation of heights (relative to their mean; missing points left out) at lags up to half the
/// map, 1 at lag 0: for each lag the mean product over all pairs of points at that lag, over Sq^2.
class Autocorrelation {
 public:
  /// InputError when every point is missing; the map must not be flat.
  explicit Autocorrelation(const HeightMap& map);

  /// Value at a lag (um) of at most reach_x, reach_y in either direction, linear between whole pitches.
  double at(double x_um, double y_um) const;
  double reach_x_um() const { return reach_x_um_; }
  double reach_y_um() const { return reach_y_um_; }

 private:
  double value(long i, long j) const;

  std::vector<double> values_;  ///< columns_ x rows_ lags, negative ones wrapped around
  std::uint32_t columns_ = 0, rows_ = 0;
  double pitch_x_um_ = 0.0, pitch_y_um_ = 0.0, reach_x_um_ = 0.0, reach_y_um_ = 0.0;
};

/// Spatial and directional parameters of ISO 25178-2:2012, 4.2. Empty where the map does not determine one.
struct MapTexture {
  /// Sal: the shortest lag in any direction at which the autocorrelation has fallen to 0.2.
  std::optional<double> sal_um;
  /// The lag at which the autocorrelation, averaged over directions, has fallen to 1/e.
  std::optional<double> correlation_length_um;
  /// Str: Sal over the longest such lag; near 1 the same in every direction, near 0 grooved.
  std::optional<double> str;
  /// True when in some direction the autocorrelation does not fall to 0.2 within half the map: Str is at most
  /// the value stated.
  bool str_is_bound = false;
  /// Std: direction of the lay (along the grooves), from x towards y, in [0, pi): perpendicular to the
  /// direction of most power. Not significant when Str is near 1.
  std::optional<double> std_rad;
};

/// Texture of a map. The power spectrum for Std is computed with a Hann window (none on a periodic map), with
/// missing points at the mean height, from two periods a width up to the Nyquist frequency, in sectors of 1
/// deg averaged over 5; Std is the middle of the power within 45 deg of the maximum, weighted by cos^2 of
/// twice the angle from it. A flat map has no texture.
MapTexture map_texture(const HeightMap& map);

/// Reasons why a map describes its surface poorly, in sentences: pitch too large for its slopes (the rms
/// slope over two pitches is more than 10 % below that over one, so that slopes depend on the
/// pitch), too few autocorrelation lengths (fewer than 10 Sal in the shorter side, with which Sq is known to
/// about 7 %), missing points. Empty when there is nothing to report.
std::vector<std::string> map_warnings(const HeightMap& map, const MapStatistics& statistics,
                                      const MapTexture& texture);

}  // namespace scintray::topography
