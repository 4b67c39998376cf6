#include "scintray/transport/detail/lane_kind.hpp"

#include "scintray/scene/lane_surface_at.hpp"

namespace scintray::transport {

LaneKind lane_kind(const scene::Scene& scene, core::RegionId region, int lane_width) {
  if (lane_width == 1 || !scene.regions[region].in_lanes) return LaneKind::none;
  const scene::LaneShares shares = scene::lane_shares(scene, scene.regions[region]);
  return shares.smooth > 0.5 ? LaneKind::smooth : LaneKind::surfaces;
}

}  // namespace scintray::transport
