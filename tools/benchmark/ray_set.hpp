#pragma once
/// Rays of isotropic light in a region, and what they hit: for the comparison of ray queries.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scintray/core/vec.hpp"
#include "scintray/scene/accelerator.hpp"

namespace scintray::bench {

/// Rays in the frame of a region, as arrays of each coordinate.
struct RaySet {
  /// x, y and z of the origin (mm), then of the direction.
  std::array<std::vector<double>, 6> doubles;
  std::array<std::vector<float>, 6> floats;  ///< the same, rounded

  std::size_t size() const { return doubles[0].size(); }
  core::Vec3 origin(std::size_t i) const { return {doubles[0][i], doubles[1][i], doubles[2][i]}; }
  core::Vec3 direction(std::size_t i) const { return {doubles[3][i], doubles[4][i], doubles[5][i]}; }
  void add(const core::Vec3& origin, const core::Vec3& direction);
};

/// What each ray hits.
struct RayHits {
  std::vector<std::uint32_t> triangle;  ///< scene::kNoTriangle: none
  std::vector<float> distance_mm;

  explicit RayHits(std::size_t rays) : triangle(rays), distance_mm(rays) {}
};

/// Rays as those of isotropic light in a region: half of them start on its boundary, uniform over the area
/// with the density of a cosine law (Lambert), half on such a ray, uniform over its length. Neighbours have
/// nothing in common. The same for every call.
RaySet isotropic_rays(const scene::Accelerator& region, std::size_t count);

}  // namespace scintray::bench
