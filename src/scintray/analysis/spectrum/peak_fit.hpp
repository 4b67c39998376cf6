#pragma once
/// Fits of a Gaussian peak, with or without a shoulder, to a histogram by maximum likelihood.

#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

/// Background under the peak.
enum class PeakBackground {
  none,
  shoulder,               ///< a step down at the peak, smeared with the peak's width
  shoulder_and_constant,  ///< and a constant level that continues beyond it
};

/// Density of counts at x:
///
///     events N(x; position, sigma) + shoulder erfc((x - position) / (sqrt(2) sigma)) / 2 + constant
///
/// The smeared step is the contribution of scattered photons, and of events with small losses, under a
/// photopeak (G. W. Phillips and K. W. Marlow 1976, Nucl. Instrum. Methods 137, 525).
struct PeakModel {
  double position = 0.0;
  double sigma = 1.0;
  double events = 0.0;    ///< in the Gaussian
  double shoulder = 0.0;  ///< counts per unit of x, far below the peak
  double constant = 0.0;  ///< counts per unit of x

  double density(double x) const;
  /// Expected counts between two values: the exact integral.
  double expected(double low, double high) const;
};

struct PeakFit {
  bool converged = false;
  PeakModel model;
  PeakBackground background = PeakBackground::none;
  core::Estimate position, sigma, events;
  core::Estimate relative_fwhm;  ///< FWHM over position
  double deviance = 0.0;         ///< twice the log likelihood ratio to the saturated model
  core::ChiSquare goodness;      ///< Pearson's, over bins merged until each expects 10 counts
};

/// Fit by the maximum of the Poisson likelihood of all bins, found as the least sum of squared deviance
/// residuals (S. Baker and R. D. Cousins 1984, Nucl. Instrum. Methods 221, 437) by GSL's trust-region
/// Levenberg-Marquardt; widths and heights are fitted as logarithms, so they stay positive. Errors are
/// those of the inverse Fisher information at the maximum. Not converged when there are fewer filled bins
/// than parameters.
/// @param start  start of the search; its sigma and events must be positive
PeakFit fit_peak(const Histogram& histogram, const PeakModel& start, PeakBackground background);

/// Mean of the fits with each background, whose parameters have the weights exp(-BIC / 2), with BIC =
/// deviance + parameters ln(pulses) (G. Schwarz 1978, as stated by Wikipedia, "Bayesian information
/// criterion"; weights as Program MARK states them under "QAICc Weight"): unlike the choice of one
/// background, it follows the counts without steps. Background is that of the largest weight. Errors include
/// the differences of the fits. Not converged when no fit is.
PeakFit fit_peak(const Histogram& histogram, const PeakModel& start);

}  // namespace scintray::analysis
