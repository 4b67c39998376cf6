#pragma once
/// Nodes of a surface table: shares and distributions of direction of the light at one incidence angle.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scintray/optics/table_bins.hpp"

namespace scintray::optics {

/// Cumulative probability at polar edge k in [0, kPolarBins]. Bins hold equal steps of s with P = 2 s^2 below
/// the median and, mirrored, 1 - 2 (1 - s)^2 above. Steps are fine in both tails, and a density that vanishes
/// linearly at an end (sin(theta) at the pole, the cosine law at the horizon) becomes uniform in s there, so
/// that linear interpolation inside bins is exact.
constexpr double polar_level(int k) {
  const double s = static_cast<double>(k) / kPolarBins;
  return s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
}

/// Cumulative probability at |azimuth| edge k in [0, kAzimuthBins]: P = 1 - (1 - s)^2. The density of
/// |azimuth| is flat at 0, and bins are fine in the tail.
constexpr double azimuth_level(int k) {
  const double s = static_cast<double>(k) / kAzimuthBins;
  return s * (2.0 - s);
}

/// Cumulative probability at edge k in [0, kAzimuthBins] of a signed azimuth, for tables of directional
/// surfaces: fine in both tails, as polar_level.
constexpr double signed_azimuth_level(int k) {
  const double s = static_cast<double>(k) / kAzimuthBins;
  return s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
}

/// Convention of a table's azimuths.
enum class AzimuthKind {
  folded,       ///< |azimuth| in [0, pi]: isotropic surface, symmetric about the plane of incidence
  directional,  ///< signed azimuth in [-pi, pi], and a slice of the table per azimuth of incidence
};

/// Distribution of the directions of light that leaves on one side, for one incidence node, as quantiles at
/// fixed levels: `polar` holds the quantiles of the polar angle (rad, from the outgoing normal of the side)
/// at `polar_level`, and within each polar bin `azimuth` those of the azimuth from the plane of incidence
/// (rad, 0 is forward, the specular side, positive about the outward normal) at `azimuth_level` of |azimuth|
/// or `signed_azimuth_level`. Sampling needs no search, is continuous inside bins, and bins are narrow where
/// light is dense. Empty when no ray left on that side.
struct DirectionQuantiles {
  std::vector<float> polar;    ///< kPolarBins + 1 edges
  std::vector<float> azimuth;  ///< kPolarBins x (kAzimuthBins + 1) edges, row-major
  std::uint64_t rays = 0;      ///< rays behind this distribution
  bool empty() const { return polar.empty(); }
};

/// Direction of exit: polar angle and azimuth, rad.
struct ExitAngles {
  float polar = 0.0f;
  float azimuth = 0.0f;
};

/// Quantiles of a sample of directions, which is reordered. Quantiles of n values are placed at the order
/// statistics (k + 1/2)/n, linear between them and for the half step beyond. Empty for an empty sample.
DirectionQuantiles quantiles_of(std::vector<ExitAngles>& sample, AzimuthKind kind = AzimuthKind::folded);

/// Shares and distributions for one incidence angle from one side.
struct TableNode {
  double incidence_rad = 0.0;
  double reflectance = 0.0;
  double reflectance_error = 0.0;  ///< one-sigma
  double absorptance = 0.0;        ///< zero without a reflector or absorbing layer in the table
  double absorptance_error = 0.0;  ///< one-sigma
  double mean_slope_rad = 0.0;  ///< mean angle between the normal of the first facet hit and the mean normal
  double traced_incidence_rad = 0.0;  ///< incidence angle that was traced: below incidence_rad at 90 deg only
  std::uint64_t rays = 0;
  DirectionQuantiles reflected, transmitted;
  double transmittance() const { return std::max(0.0, 1.0 - reflectance - absorptance); }
};

}  // namespace scintray::optics
