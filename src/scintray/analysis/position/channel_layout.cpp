#include "scintray/analysis/position/channel_layout.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::analysis {

namespace {

constexpr double kOnePlane_mm = 0.1, kEndShare = 0.1;

core::Vec3 flattest_axis(std::span<const core::Vec3> channels_mm) {
  core::Vec3 low = channels_mm.front(), high = low;
  for (const core::Vec3& at : channels_mm) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  // The last of equals: the depth of one channel, or of a row of them, is along z.
  Eigen::Index flattest = 2;
  for (Eigen::Index k = 1; k >= 0; --k)
    if ((high - low)[k] < (high - low)[flattest]) flattest = k;
  return core::Vec3::Unit(flattest);
}

void set_across(ChannelLayout& layout, const core::Vec3& direction) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) < 1.0 - 1e-9) continue;
    layout.across_x = core::Vec3::Unit(k == 0 ? 1 : 0);
    layout.across_y = core::Vec3::Unit(k == 2 ? 1 : 2);
    return;
  }
  const core::Frame frame = core::Frame::about(direction);
  layout.across_x = frame.x;
  layout.across_y = frame.y;
}

}  // namespace

std::optional<ChannelLayout> layout_of(std::span<const core::Vec3> channels_mm,
                                       const std::optional<DepthAxis>& axis) {
  if (channels_mm.empty()) return std::nullopt;
  const core::Vec3 direction = axis ? axis->direction : flattest_axis(channels_mm);
  std::vector<double> depths;
  for (const core::Vec3& at : channels_mm) depths.push_back(at.dot(direction));
  const auto [low, high] = std::minmax_element(depths.begin(), depths.end());
  const double span = *high - *low;
  ChannelLayout layout;
  set_across(layout, direction);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (span <= kOnePlane_mm || depths[i] - *low <= kEndShare * span)
      layout.near.push_back(i);
    else if (*high - depths[i] <= kEndShare * span)
      layout.far.push_back(i);
    else
      return std::nullopt;
  }
  return layout;
}

}  // namespace scintray::analysis
