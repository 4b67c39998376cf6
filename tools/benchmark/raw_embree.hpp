#pragma once
/// Embree alone: the speed against which the tracer is measured.

#include <vector>

#include "scintray/scene/accelerator.hpp"

namespace scintray::bench {

struct RawRay {
  float origin[3], direction[3];
};

/// Embree's own rays per second, one ray at a time on one thread, for rays on a mesh: nothing but
/// filling the ray, the query, and adding up the hits.
class RawEmbree {
 public:
  explicit RawEmbree(const std::vector<scene::BoundaryTriangle>& triangles);
  ~RawEmbree();
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;

  double rays_per_second(const std::vector<RawRay>& rays);
  /// Sum of the hit distances of the last call: shows that the work was done.
  double checksum() const { return checksum_; }

 private:
  struct State;
  State* state_;
  double checksum_ = 0.0;
};

}  // namespace scintray::bench
