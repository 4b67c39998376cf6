#include "scintray/analysis/position/channel_layout.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scintray::analysis {

std::optional<std::array<double, 2>> anger_position(std::span<const double> light,
                                                    std::span<const std::array<double, 2>> channels_mm,
                                                    const AngerOptions& options) {
  if (light.size() != channels_mm.size())
    throw std::invalid_argument("as many channels as positions are needed");
  if (!(options.power > 0.0) || !(options.threshold >= 0.0 && options.threshold < 1.0))
    throw std::invalid_argument("the power is above 0, the threshold from 0 to below 1");
  const double brightest = light.empty() ? 0.0 : *std::max_element(light.begin(), light.end());
  if (!(brightest > 0.0)) return std::nullopt;
  double sum = 0.0;
  std::array<double, 2> position{};
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (!(light[i] > 0.0) || light[i] < options.threshold * brightest) continue;
    const double weight = options.power == 1.0 ? light[i] : std::pow(light[i], options.power);
    sum += weight;
    for (std::size_t k = 0; k < 2; ++k) position[k] += weight * channels_mm[i][k];
  }
  for (double& coordinate : position) coordinate /= sum;
  return position;
}

}  // namespace scintray::analysis
