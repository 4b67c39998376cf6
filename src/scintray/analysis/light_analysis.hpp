#pragma once
/// Light from the tallies of a result: crosstalk, light spread, divergence, etendue.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::analysis {

/// Share of the light of each part that each sensor detects.
struct Crosstalk {
  std::vector<std::string> sources, sensors;
  std::vector<std::uint64_t> emitted;              ///< per source
  std::vector<std::vector<core::Estimate>> share;  ///< [source][sensor], of the photons emitted there
};

/// From a "crosstalk" tally and its companion "NAME: emitted". Errors are binomial.
/// @throws InputError when the point has no such tally.
Crosstalk read_crosstalk(const tally::PointResult& point, const std::string& name);

/// Crossings of a face by their angle to its normal, from the two histograms of an exit angle tally.
struct CrossingAngles {
  std::string name;
  std::string face;            ///< "part:face"
  bool detected_only = false;  ///< counts each detected photon's last crossing; else every crossing
  std::vector<std::uint64_t>
      inside;  ///< in equal bins of 0 to 90 deg: angle in the medium of the face's part
  std::vector<std::uint64_t> outside;  ///< angle in the medium beyond
};

/// Of all exit angle tallies of a point, in their order.
std::vector<CrossingAngles> crossing_angles(const tally::PointResult& point);
/// The tallies whose crossings they are. They count each crossing as a photon of its own: of several
/// crossings of one photon the sums of squares do not know.
std::vector<tally::TallyResult> tallies_of(const CrossingAngles& angles);

/// Half-angles of a cone about the normal that holds a share of the light.
struct Divergence {
  core::Estimate half_rad;    ///< half of the light
  core::Estimate ninety_rad;  ///< nine tenths
  core::Estimate mean_cosine;
  std::uint64_t photons = 0;
};

/// From a histogram over equal bins of 0 to 90 deg, even within each bin. The error of a quantile is
/// sqrt(q (1 - q) / N) over the density there (Kendall & Stuart, The Advanced Theory of Statistics,
/// vol. 1, section 10.10), with half a bin's width divided by sqrt(3) for what the bins hide, in quadrature.
Divergence divergence(const std::vector<std::uint64_t>& counts);

/// Centre and width of light on a grid.
struct LightSpread {
  double centre_mm[2] = {0.0, 0.0};
  double centre_error_mm[2] = {0.0, 0.0};
  double rms_mm[2] = {0.0, 0.0};   ///< about the centre, of pixel centres
  double fwhm_mm[2] = {0.0, 0.0};  ///< of the sums across the other direction, linear between pixels
  double photons = 0.0;
};

/// From a tally whose two axes are positions ("light_spread", "irradiance").
/// @throws InputError when it has other axes.
LightSpread light_spread(const tally::TallyResult& tally);

/// Etendue that light fills.
struct Etendue {
  core::Estimate filled_mm2_sr;  ///< n^2 times area times projected solid angle
  double grid_mm2_sr = 0.0;      ///< of the whole grid: the most it can be
  double index = 0.0;            ///< n
};

/// From an "etendue" tally, whose axes are two positions, squared sine and azimuth. What is returned is
///
///     G = (integral of L dG)^2 / integral of L^2 dG
///
/// with L the radiance divided by n^2 and dG = n^2 dA dOmega cos(theta). Light of one radiance fills
/// exactly its G, and since neither L / n^2 nor dG change along rays in lossless smooth optics
/// (Liouville; R. Winston et al., Nonimaging Optics, 2005, section 2.6 and appendix A), neither does G.
/// Bins, equal in dG, blur: G is never less than a bin's and comes out larger where L varies within bins.
/// The integral of L^2 is estimated without bias from pairs of photons, n (n - 1) a bin; its error is
/// that of a U-statistic (W. Hoeffding 1948, Ann. Math. Statist. 19, 293).
/// @throws InputError when the tally is of another type, or in a medium of no one index.
Etendue read_etendue(const tally::TallyResult& tally);

/// A tally by name. @throws InputError, naming those there are.
const tally::TallyResult& find_tally(const tally::PointResult& point, const std::string& name);

}  // namespace scintray::analysis
