#pragma once
/// The boundary of each region and its accelerator.

#include <vector>

#include "scintray/scene/detail/assemble.hpp"

namespace scintray::scene {

/// Id of a part's region, or of the ambient one for no part: it comes first, then the parts' in their order.
inline core::RegionId region_of(core::PartId part) {
  return part.has_value() ? core::RegionId(part.index() + 1) : kAmbientRegion;
}

/// Fills scene.regions from interface triangles; `interface_of[i]` is the interface of triangles[i].
/// Regions whose boundaries are equal in their parts' own frames, and lead to the same pattern of
/// interfaces, share one accelerator.
void build_regions(const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles,
                   const std::vector<core::InterfaceId>& interface_of, Scene& scene);

}  // namespace scintray::scene
