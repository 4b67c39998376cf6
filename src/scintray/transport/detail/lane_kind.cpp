#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"

namespace scintray::transport {

LaneKind lane_kind(const scene::Scene& scene, core::RegionId region, int lane_width) {
  if (lane_width == 1 || !scene.regions[region].in_lanes) return LaneKind::none;
  const scene::LaneShares shares = scene::lane_shares(scene, scene.regions[region]);
  // With few total reflections in a row, entering and leaving the lanes costs more than they save.
  if (shares.smooth > 0.5) return shares.total > 0.5 ? LaneKind::smooth : LaneKind::none;
  if (scene.regions[region].curved) return LaneKind::none;
  return lane_kernels(lane_width).run ? LaneKind::surfaces : LaneKind::none;
}

LaneKinds lane_kinds(const scene::Scene& scene, int lane_width) {
  LaneKinds kinds;
  for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
    kinds.push_back(lane_kind(scene, core::RegionId(i), lane_width));
  return kinds;
}

}  // namespace scintray::transport
