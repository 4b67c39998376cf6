#pragma once
/// Where the photopeak of a spectrum is, roughly: what a fit starts from.

#include <optional>
#include <span>

namespace scintray::analysis {

struct PeakPlace {
  double position = 0.0;
  double sigma = 0.0;        ///< from the half width at half maximum above the peak
  double sigma_below = 0.0;  ///< from that below it: a shoulder makes it larger
  double height = 0.0;       ///< density of values at the peak, smoothed
  double valley = 0.0;       ///< lowest point between the peak and what lies below it
};

/// The highest in x of the maxima that stand out and have a tenth of the height of the highest; see
/// fit_photopeak. @param sorted  rising, finite
std::optional<PeakPlace> find_photopeak(std::span<const double> sorted);

}  // namespace scintray::analysis
