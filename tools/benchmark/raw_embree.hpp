#pragma once
/// Embree alone on the rays of a scene's photons: the speed with which the tracer is compared.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "scintray/simulation/simulation_point.hpp"

namespace scintray::bench {

/// A ray in the frame of the region in which it starts, mm.
struct RecordedRay {
  float origin[3], direction[3];
  core::AcceleratorId accelerator;  ///< of the region
};

/// The rays of all segments of the first photons of a scene, in the order in which they are traced, total
/// reflections included.
/// @param most  number of rays after which recording ends
std::vector<RecordedRay> record_rays(const simulation::SimulationPoint& point, std::size_t most);

/// Embree's own rays, one at a time on one thread, on the boundaries of a scene's regions: nothing but
/// filling the ray, rtcIntersect1, and adding up the hits. Regions that the tracer queries by planes are
/// given to Embree, too.
class RawEmbree {
 public:
  /// @param rays  of this scene; its boundaries that no ray needs are left out
  RawEmbree(const scene::Scene& scene, std::vector<RecordedRay> rays);
  ~RawEmbree();
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;

  std::size_t rays() const { return rays_.size(); }
  /// Rays per second of processor time, of as many passes over the rays as take at least this time; 0 without
  /// rays.
  double rays_per_second(double seconds);
  /// Rays of the last pass that hit a triangle.
  std::uint64_t hits() const { return hits_; }

 private:
  struct Boundaries;
  void trace_once();

  std::vector<RecordedRay> rays_;
  std::unique_ptr<Boundaries> boundaries_;
  std::uint64_t hits_ = 0;
  double sum_mm_ = 0.0;  ///< of the hit distances, so that no query can be left out
};

/// Embree's version, "3.13.5".
const char* embree_version();

}  // namespace scintray::bench
