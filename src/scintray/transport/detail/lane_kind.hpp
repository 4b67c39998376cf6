#pragma once
/// Which kernel traces photons in a region.

#include "scintray/scene/scene.hpp"

namespace scintray::transport {

enum class LaneKind {
  none,      ///< photons are traced one by one
  smooth,    ///< they are propagated in lanes, through total reflections (lane_kernel.hpp)
  surfaces,  ///< they stay in lanes at rough faces and reflectors too (lane_pool.hpp)
};

/// The fastest for a region at a width of lane_widths(). No result depends on it.
LaneKind lane_kind(const scene::Scene& scene, core::RegionId region, int lane_width);

/// Of all regions of a scene.
using LaneKinds = core::IdVector<core::RegionId, LaneKind>;
LaneKinds lane_kinds(const scene::Scene& scene, int lane_width);

}  // namespace scintray::transport
