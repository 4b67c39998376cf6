#pragma once
/// Position of an event from the light of several channels.

#include <array>
#include <optional>
#include <span>

namespace scintray::analysis {

struct AngerOptions {
  /// Exponent of the light in the weights: above 1, near channels count more.
  double power = 1.0;
  /// Channels below this share of the event's brightest one are left out, 0 to below 1: reduces the bias to
  /// the middle by light that is everywhere.
  double threshold = 0.0;
};

/// Mean of the channels' positions weighted by their light (H. O. Anger 1958, Rev. Sci. Instrum. 29, 27,
/// eq. 1, with weights as in the options). Empty when no channel has light.
/// @throws std::invalid_argument when the sizes differ or an option is out of its range
std::optional<std::array<double, 2>> anger_position(std::span<const double> light,
                                                    std::span<const std::array<double, 2>> channels_mm,
                                                    const AngerOptions& options = {});

}  // namespace scintray::analysis
