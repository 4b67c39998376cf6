#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/mesh/repair/detail/passes.hpp"

namespace scintray::mesh {

std::vector<std::array<std::uint32_t, 3>> triangles_of_least_area(
    const std::vector<core::Vec3>& outline, double least_height_mm,
    const std::function<bool(std::size_t, std::size_t)>& joined) {
  constexpr double kForLength = 0.02, kNone = std::numeric_limits<double>::infinity();
  const std::size_t n = outline.size();
  if (n < 3) return {};
  const auto weight = [&](std::size_t i, std::size_t k, std::size_t j) {
    const core::Vec3 a = outline[k] - outline[i], b = outline[j] - outline[k], c = outline[i] - outline[j];
    const double twice_area = a.cross(b).norm();
    const double longest2 = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
    const bool flat = twice_area <= 2.0 * least_height_mm * std::sqrt(longest2);
    return flat ? kNone : 0.5 * twice_area + kForLength * longest2;
  };
  struct Best {
    double weight = 0.0;
    std::size_t middle = 0;
  };
  std::vector<Best> best(n * n);  // between corners i and j: the corner of the triangle at that side
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      Best& own = best[i * n + j];
      own.weight = kNone;
      if (span + 1 < n && joined(i, j)) continue;
      for (std::size_t k = i + 1; k < j; ++k) {
        const double parts = best[i * n + k].weight + best[k * n + j].weight;
        if (parts >= own.weight) continue;
        const double sum = parts + weight(i, k, j);
        if (sum < own.weight) own = {sum, k};
      }
    }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (best[n - 1].weight == kNone) return triangles;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = best[i * n + j].middle;
    triangles.push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(j)});
    open.insert(open.end(), {{i, k}, {k, j}});
  }
  return triangles;
}

}  // namespace scintray::mesh
