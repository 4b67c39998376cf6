#pragma once
/// Centre and width of a distribution of residuals or time differences.

#include <cstddef>
#include <span>

#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/analysis/spectrum/peak_fit.hpp"

namespace scintray::analysis {

struct Spread {
  std::size_t count = 0;
  core::Estimate mean;
  /// FWHM of a Gaussian fitted within 2.5 sigma of its centre; not a number unless `fit.converged`.
  core::Estimate gaussian_fwhm;
  /// Between the quantiles that enclose a Gaussian's FWHM (0.1195 and 0.8805): requires no shape and is
  /// insensitive to tails. 0 without two different values.
  core::Estimate quantile_fwhm;
  PeakFit fit;
  Histogram fitted;  ///< bins of the fit; without bins when there was no fit
};

/// Centre and width of values. The error of the Gaussian's width is that of the jackknife over 32 random
/// groups of values, or groups of four where there are fewer than 128 (core::jackknife_error): it holds also
/// where no Gaussian describes the values, and includes the contribution of the choice of the fitted range.
/// That of the quantiles' width is distribution-free: a quarter of the distance between the order statistics
/// two standard deviations (sqrt(q (1 - q) N)) to either side, with the covariance of two order statistics
/// (Kendall & Stuart, The Advanced Theory of Statistics, vol. 1, section 10.10: cited from memory, assumed).
/// Values that are not finite are left out.
Spread spread_of(std::span<const double> values);

/// The same, with the error of the fit for the Gaussian's width: faster, for values alone.
Spread quick_spread_of(std::span<const double> values);

}  // namespace scintray::analysis
