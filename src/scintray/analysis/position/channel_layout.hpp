#pragma once
/// Readout channels: their arrangement, in one plane or at two ends, and the position of an event from their
/// light.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::analysis {

/// Origin and direction of depths; `direction` has unit length.
struct DepthAxis {
  core::Vec3 origin_mm = core::Vec3::Zero();
  core::Vec3 direction = core::Vec3::UnitZ();

  double depth_mm(const core::Vec3& position_mm) const { return (position_mm - origin_mm).dot(direction); }
};

struct ChannelLayout {
  std::vector<std::size_t> near;  ///< channels of the end at the smaller depth, or of the only plane
  std::vector<std::size_t> far;   ///< of the other end; empty when there is one plane
  /// Directions perpendicular to the depth: the two other axes of the world, in their order, when depth is
  /// along one.
  core::Vec3 across_x = core::Vec3::UnitX(), across_y = core::Vec3::UnitY();

  std::array<double, 2> across(const core::Vec3& position_mm) const {
    return {position_mm.dot(across_x), position_mm.dot(across_y)};
  }
};

/// Channels sorted by their depth: all within 0.1 mm are one plane; two groups, each no deeper than a tenth
/// of the distance over which they are spread, are two ends (limits chosen). Empty for other arrangements.
/// Without an axis depth is along the axis of the world in which the channels' positions differ least.
std::optional<ChannelLayout> layout_of(std::span<const core::Vec3> channels_mm,
                                       const std::optional<DepthAxis>& axis);

struct AngerOptions {
  /// Exponent of the light in the weights: above 1, near channels count more.
  double power = 1.0;
  /// Channels below this share of the event's brightest one are left out, 0 to below 1: reduces the bias
  /// towards the middle by uniformly distributed light.
  double threshold = 0.0;
};

/// Mean of the channels' positions weighted by their light (H. O. Anger 1958, Rev. Sci. Instrum. 29, 27,
/// eq. 1, with weights as in the options). Empty when no channel has light.
/// @throws std::invalid_argument when the sizes differ or an option is out of its range
std::optional<std::array<double, 2>> anger_position(std::span<const double> light,
                                                    std::span<const std::array<double, 2>> channels_mm,
                                                    const AngerOptions& options = {});

}  // namespace scintray::analysis
