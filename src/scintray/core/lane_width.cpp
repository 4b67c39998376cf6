#include "scintray/core/lane_width.hpp"

#include <algorithm>

namespace scintray::core {

namespace {

/// Eight lanes are the default where the processor has an extension of AVX-512 that came with Ice Lake and
/// Zen 4. Earlier processors, such as Skylake-X, lower their clock for wide vectors; Ice Lake by
/// 0.1 GHz when one core works and not when several do, Rocket Lake never (T. Downs 2020, "Ice Lake AVX-512
/// Downclocking", travisdowns.github.io).
int widest_by_default() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512vbmi2")) return 8;
#endif
  return 4;
}

std::vector<int> find_widths() {
  std::vector<int> widths{1};
#if defined(__x86_64__)
  widths.push_back(2);
  // Kernels are compiled with BMI2, which processors with AVX2 have (assumed); a virtual machine may hide it.
  if (__builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2")) {
    if (__builtin_cpu_supports("avx2")) widths.push_back(4);
    if (__builtin_cpu_supports("avx512f")) widths.push_back(8);
  }
#endif
  return widths;
}

}  // namespace

const std::vector<int>& lane_widths() {
  static const std::vector<int> widths = find_widths();
  return widths;
}

int default_lane_width() {
  int width = 1;
  const int widest = widest_by_default();
  for (const int known : lane_widths())
    if (known <= widest) width = std::max(width, known);
  return width;
}

}  // namespace scintray::core
