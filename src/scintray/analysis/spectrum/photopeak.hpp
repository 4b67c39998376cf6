#pragma once
/// The photopeak of an energy spectrum, and whether its fit can be trusted.

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
  no_peak,        ///< nothing stands out of the continuum
  edge_of_range,  ///< the peak is cut off by the end of the data or of the window
  not_converged,
  poor_fit,  ///< the shape is another one (p below 1e-4): position and width are descriptions
};
/// "trusted", "too few events", ...
const char* status_name(PeakStatus status);

struct PhotopeakOptions {
  /// Only a peak in here is looked for and fitted; without, the highest in energy of those that have at
  /// least a tenth of the height of the highest.
  std::optional<std::array<double, 2>> window;
  /// Taken as given; without, the simplest that the data do not refute: a term is added when twice the
  /// log likelihood ratio is above 9 (once in 700 without cause: S. S. Wilks 1938, Ann. Math. Statist. 9,
  /// 60).
  std::optional<PeakBackground> background;
};

struct Photopeak {
  PeakStatus status = PeakStatus::no_peak;
  std::string reason;  ///< of a status other than trusted: what was found, and what was needed
  PeakFit fit;         ///< position, sigma, relative_fwhm (the energy resolution), goodness
  Histogram fitted;    ///< bins that were fitted; without bins when nothing was

  bool has_numbers() const { return fit.converged; }
  /// Chi-square above its degrees of freedom, per pulse fitted: how far the shape is from the model, whatever
  /// the number of pulses (the mean square contingency, H. Cramer 1946, Mathematical Methods of
  /// Statistics). 0 without a fit.
  double misfit() const;
  /// Good for choosing pulses and for depth curves: trusted, or a poor fit only because many pulses show a
  /// small difference (misfit below 0.01, a tenth in the root mean square).
  bool locates_peak() const;
};

/// Finds and fits the photopeak. The search smooths the spectrum at falling widths and takes the first
/// width finer than half the peak it shows; a maximum counts when it stands 4 standard errors above the
/// valleys beside it. The fit spans from 3 sigma below the peak, or the valley when that is nearer, to 4
/// sigma above, in bins of sigma / 4, and is repeated until the span agrees with what it finds.
/// @param values  one a pulse, any positive unit; values that are not finite are left out
Photopeak fit_photopeak(std::span<const double> values, const PhotopeakOptions& options = {});

}  // namespace scintray::analysis
