#pragma once
/// Embree's rays on one boundary, one at a time or in packets.

#include <memory>
#include <string>

#include "ray_set.hpp"

namespace scintray::bench {

/// Embree's scene of a boundary, with the settings of scene/accelerator.cpp.
class EmbreeRays {
 public:
  /// @param max_isa  widest instruction set that Embree may use: "avx2", "avx512"
  EmbreeRays(const scene::Accelerator& region, const std::string& max_isa);
  ~EmbreeRays();
  EmbreeRays(const EmbreeRays&) = delete;
  EmbreeRays& operator=(const EmbreeRays&) = delete;

  /// Whether Embree has code for packets of this size on this processor, 4, 8 or 16.
  bool has_packets(int size) const;
  /// First hits of rays by rtcIntersect1, from either side of a triangle.
  void trace_single(const RaySet& rays, RayHits& hits) const;
  /// The same by rtcIntersect4, 8 or 16. @param size  divides the number of rays
  void trace_packets(int size, const RaySet& rays, RayHits& hits) const;

 private:
  struct Handles;
  template <typename Packet>
  void trace_packets_of(const RaySet& rays, RayHits& hits) const;

  std::unique_ptr<Handles> handles_;
  float start_mm_ = 0.0f;  ///< distance from the origin at which rays start
};

}  // namespace scintray::bench
