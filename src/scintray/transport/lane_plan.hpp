#pragma once
/// Which photons of a scene are traced several at once, in the lanes of vector registers, and how.

#include <memory>

#include "scintray/scene/scene.hpp"

namespace scintray::transport {

class LaneScene;

/// Which kernel traces photons in a region.
enum class LaneKind {
  none,      ///< photons are traced one by one
  smooth,    ///< they are propagated in lanes, through total reflections (lane_kernel.hpp)
  surfaces,  ///< they stay in lanes at surfaces, and from region to region (lane_pool.hpp)
};

/// The fastest kernels for all regions of a scene at a width of lane_widths(). No result depends on them.
using LaneKinds = core::IdVector<core::RegionId, LaneKind>;
LaneKinds lane_kinds(const scene::Scene& scene, int lane_width);

/// A number of lanes, kernels for the regions of a scene, and what they need of the scene. Serves any number
/// of threads.
class LanePlan {
 public:
  /// @param lane_width  of lane_widths(). @throws InternalError for another
  /// @param kinds       of the scene at that width
  LanePlan(const scene::Scene& scene, int lane_width, LaneKinds kinds);
  /// With the fastest kernels.
  LanePlan(const scene::Scene& scene, int lane_width)
      : LanePlan(scene, lane_width, lane_kinds(scene, lane_width)) {}
  ~LanePlan();

  int width() const { return width_; }
  LaneKind kind(core::RegionId region) const { return kinds_[region]; }
  /// The regions of LaneKind::surfaces.
  const LaneScene& scene() const { return *scene_; }

 private:
  int width_;
  LaneKinds kinds_;
  std::unique_ptr<const LaneScene> scene_;
};

}  // namespace scintray::transport
