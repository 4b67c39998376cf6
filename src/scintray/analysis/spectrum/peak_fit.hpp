#pragma once
/// A Gaussian peak, on a shoulder or not, fitted to a histogram by maximum likelihood.

#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

/// What lies under the peak.
enum class PeakBackground {
  none,
  shoulder,               ///< a step down at the peak, smeared as the peak is
  shoulder_and_constant,  ///< and a level that goes on beyond it
};

/// Density of counts at x:
///
///     events N(x; position, sigma) + shoulder erfc((x - position) / (sqrt(2) sigma)) / 2 + constant
///
/// The smeared step is what photons scattered on their way, and events that lost a little, leave under a
/// photopeak (G. W. Phillips and K. W. Marlow 1976, Nucl. Instrum. Methods 137, 525).
struct PeakModel {
  double position = 0.0;
  double sigma = 1.0;
  double events = 0.0;    ///< in the Gaussian
  double shoulder = 0.0;  ///< counts per unit of x, far below the peak
  double constant = 0.0;  ///< counts per unit of x

  double density(double x) const;
  /// Counts expected between two values: the exact integral.
  double expected(double low, double high) const;
};

struct PeakFit {
  bool converged = false;
  PeakModel model;
  PeakBackground background = PeakBackground::none;
  core::Estimate position, sigma, events;
  core::Estimate relative_fwhm;  ///< FWHM over position
  double deviance = 0.0;         ///< twice the log of the likelihood ratio to a model that fits every bin
  core::ChiSquare goodness;      ///< Pearson's, over bins merged until each expects 10 counts
};

/// Maximum of the Poisson likelihood of all bins, found as the least sum of squared deviance residuals
/// (S. Baker and R. D. Cousins 1984, Nucl. Instrum. Methods 221, 437) by GSL's trust-region
/// Levenberg-Marquardt; widths and heights are fitted as logarithms, so they stay positive. Errors are
/// those of the inverse Fisher information at the maximum. Not converged when there are fewer filled bins
/// than parameters.
/// @param start  where the search begins; its sigma and events must be positive
PeakFit fit_peak(const Histogram& histogram, const PeakModel& start, PeakBackground background);

}  // namespace scintray::analysis
