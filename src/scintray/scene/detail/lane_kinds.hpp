#pragma once
/// How photons in the regions of a scene are best traced in lanes.

#include "scintray/scene/scene.hpp"

namespace scintray::scene {

/// Sets Region::lanes and Region::unfolds of all regions, which requires all else of the scene.
///
/// Lanes are for regions that are not rotated and not of a birefringent medium, bounded by planes or one
/// convex body, or with thin gaps: where most of the boundary is smooth and light is often totally reflected,
/// and, except in bodies, where most of it has surfaces for lanes (lane_surface_at.hpp), as long as most of
/// the light there stays in lanes.
void set_lane_kinds(Scene& scene);

}  // namespace scintray::scene
