#pragma once
/// Light from the tallies of a result: crosstalk, light spread, divergence, etendue.
///
/// With a source of photons errors are those of independent photons, by the formula stated at each. With an
/// event source they are those of independent events, by the jackknife over groups of events
/// (core::jackknife_error, tally::TallyResult::group_sums); of a result without such sums, or where a group
/// has all the light, those of independent photons.

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

/// Crosstalk from a "crosstalk" tally and its companion "NAME: emitted". Errors of independent photons are
/// binomial.
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
  /// Of both, tally::TallyResult::group_sums.
  std::vector<double> inside_groups = {}, outside_groups = {};
};

/// Of all exit angle tallies of a point, in their order.
std::vector<CrossingAngles> crossing_angles(const tally::PointResult& point);
/// The tallies whose crossings they are. Each crossing counts as a photon of its own: the sums of
/// squares neglect that several crossings may be of one photon.
std::vector<tally::TallyResult> tallies_of(const CrossingAngles& angles);

/// Half-angles of the cones about the normal that contain a share of the light.
struct Divergence {
  core::Estimate half_rad;    ///< half of the light
  core::Estimate ninety_rad;  ///< nine tenths
  core::Estimate mean_cosine;
  std::uint64_t photons = 0;
};

/// Divergence from a histogram over equal bins of 0 to 90 deg, uniform within each bin. The error of a
/// quantile is sqrt(q (1 - q) / N) over the density there (Kendall & Stuart, The Advanced Theory of
/// Statistics, vol. 1, section 10.10), with half a bin's width divided by sqrt(3) for the binning, in
/// quadrature.
/// @param groups  the histograms of groups of events, tally::TallyResult::group_sums; empty: the photons are
///                independent
Divergence divergence(const std::vector<std::uint64_t>& counts, const std::vector<double>& groups = {});

/// Centre and width of light on a grid.
struct LightSpread {
  double centre_mm[2] = {0.0, 0.0};
  double centre_error_mm[2] = {0.0, 0.0};
  double rms_mm[2] = {0.0, 0.0};   ///< about the centre, of pixel centres
  double fwhm_mm[2] = {0.0, 0.0};  ///< of the sums over the other direction, linear between pixels
  double photons = 0.0;
};

/// Light spread from a tally whose two axes are positions ("light_spread", "irradiance").
/// @throws InputError when it has other axes.
LightSpread light_spread(const tally::TallyResult& tally);

/// Etendue of light.
struct Etendue {
  core::Estimate filled_mm2_sr;  ///< n^2 times area times projected solid angle
  double grid_mm2_sr = 0.0;      ///< of the whole grid: the upper limit
  double index = 0.0;            ///< n
};

/// Etendue from an "etendue" tally, whose axes are two positions, squared sine and azimuth:
///
///     G = (integral of L dG)^2 / integral of L^2 dG
///
/// with L the radiance divided by n^2 and dG = n^2 dA dOmega cos(theta). Light of constant L has exactly
/// the G that it fills, and since neither L nor dG changes along rays in lossless smooth optics
/// (Liouville; R. Winston et al., Nonimaging Optics, 2005, section 2.6 and appendix A), neither does G.
/// Bins, equal in dG, limit the resolution: G is at least that of a bin, and overestimated where L varies
/// within bins.
/// The integral of L^2 is estimated without bias from pairs of photons, n (n - 1) per bin; its error is
/// that of a U-statistic (W. Hoeffding 1948, Ann. Math. Statist. 19, 293).
/// @throws InputError when the tally is of another type, or in a medium without a single index.
Etendue read_etendue(const tally::TallyResult& tally);

/// A tally by name. @throws InputError, with the names that exist, when there is none
const tally::TallyResult& find_tally(const tally::PointResult& point, const std::string& name);

}  // namespace scintray::analysis
