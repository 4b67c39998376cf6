#pragma once
/// Rays against all triangles of a region, several at once in lanes.

#include <memory>
#include <string>
#include <vector>

#include "ray_set.hpp"
#include "triangle_lanes.hpp"

namespace scintray::bench {

/// What the lanes of a vector register hold.
enum class LanesOf { triangles, rays };

/// Kernels of one vector register: 4 doubles, 8 doubles, 8 floats, 16 floats.
struct LaneWays {
  std::string numbers;  ///< "4 double"
  std::size_t width = 0;
  bool single_precision = false;
  TriangleKernel<double> doubles[2] = {};  ///< by LanesOf
  TriangleKernel<float> floats[2] = {};
};

/// Those that this build has and this processor can run.
std::vector<LaneWays> lane_ways();

/// The triangles of a region as the kernels of one register read them.
class AllTriangles {
 public:
  AllTriangles(const scene::Accelerator& region, const LaneWays& ways);
  /// The nearest triangles through which rays leave the region. @param rays  a multiple of the width
  void trace(LanesOf lanes, const RaySet& rays, RayHits& hits) const;

 private:
  LaneWays ways_;
  std::size_t triangles_ = 0;
  double behind_mm_ = 0.0;
  std::vector<double> doubles_[2];  ///< tests, by LanesOf
  std::vector<float> floats_[2];
};

}  // namespace scintray::bench
