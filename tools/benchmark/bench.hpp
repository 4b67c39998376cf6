#pragma once
/// What is measured, each printed as it is done.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace scintray::bench {

/// Photons in the paper's crystal against Embree alone.
void bench_crystal();
/// Arrays of crystals and a part of a million triangles: building, memory, tracing.
void bench_arrays();
/// Tracing a height map and building tables from it, against Embree alone on the same map.
void bench_tables();

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace scintray::bench
