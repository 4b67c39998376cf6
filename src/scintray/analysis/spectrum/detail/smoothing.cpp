#include "scintray/analysis/spectrum/detail/smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::analysis {

std::vector<double> gaussian_kernel(double sigma_cells) {
  const int reach = std::max(1, static_cast<int>(std::ceil(4.0 * sigma_cells)));
  std::vector<double> kernel;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(std::exp(-0.5 * k * k / (sigma_cells * sigma_cells)));
    sum += kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

std::vector<double> convolved(const std::vector<double>& map, const std::vector<double>& kernel,
                              const CellLines& lines) {
  const int reach = static_cast<int>(kernel.size() / 2), length = static_cast<int>(lines.length);
  std::vector<double> out(map.size(), 0.0);
  for (std::size_t line = 0; line < lines.count; ++line)
    for (int i = 0; i < length; ++i) {
      double sum = 0.0;
      for (int k = std::max(-reach, -i); k <= reach && i + k < length; ++k)
        sum += kernel[static_cast<std::size_t>(k + reach)] *
               map[line * lines.step + static_cast<std::size_t>(i + k) * lines.cell_step];
      out[line * lines.step + static_cast<std::size_t>(i) * lines.cell_step] = sum;
    }
  return out;
}

}  // namespace scintray::analysis
