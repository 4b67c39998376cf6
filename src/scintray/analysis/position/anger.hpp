#pragma once
/// Where an event was, from the light of several channels.

#include <array>
#include <optional>
#include <span>

namespace scintray::analysis {

struct AngerOptions {
  /// Light is raised to this power before it is a weight: above 1 near channels count for more.
  double power = 1.0;
  /// Channels below this share of the event's brightest one are left out, 0 to below 1: less pull to the
  /// middle by light that is everywhere.
  double threshold = 0.0;
};

/// Mean of the channels' positions weighted with their light (H. O. Anger 1958, Rev. Sci. Instrum. 29, 27,
/// eq. 1, with weights as in the options). Nothing when no channel saw light.
/// @throws std::invalid_argument when the sizes differ or an option is out of its range
std::optional<std::array<double, 2>> anger_position(std::span<const double> light,
                                                    std::span<const std::array<double, 2>> channels_mm,
                                                    const AngerOptions& options = {});

}  // namespace scintray::analysis
