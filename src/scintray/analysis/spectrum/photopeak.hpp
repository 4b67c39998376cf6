#pragma once
/// The photopeak of an energy spectrum, and the reliability of its fit.

#include <array>
#include <optional>
#include <span>
#include <string>

#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/analysis/spectrum/peak_fit.hpp"

namespace scintray::analysis {

enum class PeakStatus {
  trusted,
  too_few,        ///< not enough events
  no_peak,        ///< no peak above the continuum
  edge_of_range,  ///< the peak is truncated by the end of the data or of the window
  not_converged,
  uncertain_width,  ///< peak and background cannot be distinguished: sigma is known to an eighth only, or
                    ///< worse
  poor_fit,         ///< the shape differs (p below 1e-4, chosen): position and width are only descriptive
};
/// Text of a status: "trusted", "too few events", ...
const char* status_name(PeakStatus status);

struct PhotopeakOptions {
  /// Range in which a peak is searched and fitted; without it, the peak of highest energy among those with at
  /// least a tenth (chosen) of the height of the highest.
  std::optional<std::array<double, 2>> window;
  /// Background model; without it, the mean of the fits with each (fit_peak).
  std::optional<PeakBackground> background;
};

struct Photopeak {
  PeakStatus status = PeakStatus::no_peak;
  std::string reason;  ///< of a status other than trusted: the value found and the one required
  PeakFit fit;         ///< position, sigma, relative_fwhm (the energy resolution), goodness
  Histogram fitted;    ///< bins that were fitted; without bins when none were

  bool has_numbers() const { return fit.converged; }
  /// Chi-square above its degrees of freedom, per pulse fitted: the deviation of the shape from the model,
  /// independent of the number of pulses (the mean square contingency, H. Cramer 1946, Mathematical Methods
  /// of Statistics). 0 without a fit.
  double misfit() const;
  /// Usable for selecting pulses and for depth curves: trusted; or of uncertain width, as the position is
  /// still known to a fraction of it; or a poor fit only because many pulses reveal a small difference
  /// (misfit below 0.01, chosen: a tenth in the root mean square).
  bool locates_peak() const;
};

/// Search and fit of the photopeak. The search smooths the spectrum with decreasing widths and uses the first
/// width finer than half the peak found; a maximum counts when it is 4 standard errors (chosen) above the
/// valleys beside it. The fit spans from 3 sigma below the peak to 4 sigma above, in bins of sigma / 4; where
/// a continuum rises within that, from 1.6 times the distance at which the smoothed spectrum has fallen to a
/// quarter of its height above the valley (1.5 to 3 sigma). It is repeated until the span agrees with the
/// result. These limits are chosen such that pulls over a thousand runs have width 1 (docs/decisions.md).
/// The errors are those of the jackknife over quarters of the values, in 12 random divisions: they
/// hold also where the model does not describe the spectrum exactly, and include the contributions of span
/// and background; where a fit of three quarters fails, they are the fit's own. That of `events` treats the
/// number of pulses as Poisson distributed.
/// @param values  one per pulse, in any positive unit; values that are not finite are left out
Photopeak fit_photopeak(std::span<const double> values, const PhotopeakOptions& options = {});

}  // namespace scintray::analysis
