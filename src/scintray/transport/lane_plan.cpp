#include "scintray/transport/lane_plan.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

LaneKind kind_by_itself(const scene::Scene& scene, const scene::Region& region) {
  if (!region.in_lanes) return LaneKind::none;
  const scene::LaneShares shares = scene::lane_shares(scene, region);
  const bool surfaces = !region.curved && shares.known > 0.5;
  // With few total reflections in a row, entering and leaving the lanes costs more than they save.
  if (shares.smooth > 0.5 && shares.total > 0.5 && !region.thin_gaps && !std::getenv("TOG")) return LaneKind::smooth;
  return surfaces ? LaneKind::surfaces : LaneKind::none;
}

bool goes_on_in_lanes(const scene::Scene& scene, const scene::BoundaryLink& link, const LaneKinds& kinds) {
  const std::optional<optics::LaneSurface> surface = scene::lane_surface_at(scene, link);
  if (!surface) return false;
  if (surface->reflector || surface->micro != optics::LaneSurface::Micro::smooth) return true;
  const scene::Interface& interface = scene.interfaces[link.interface];
  return kinds[link.from_back ? interface.front : interface.back] == LaneKind::surfaces &&
         !reaches_sensor(scene, interface, link.from_back);
}

/// Share of a region's boundary from which light goes on in lanes: into regions of LaneKind::surfaces, or back
/// from a reflector.
double share_in_lanes(const scene::Scene& scene, const scene::Region& region, const LaneKinds& kinds) {
  const scene::BoundaryLink* const links = scene.links_of(region);
  double all = 0.0, in_lanes = 0.0;
  for (std::uint32_t i = 0; i < scene.accelerator(region).size(); ++i) {
    const double area = scene::area_of(scene.accelerator(region).triangle(i));
    all += area;
    if (goes_on_in_lanes(scene, links[i], kinds)) in_lanes += area;
  }
  return in_lanes / all;
}

}  // namespace

LaneKinds lane_kinds(const scene::Scene& scene, int lane_width) {
  LaneKinds kinds;
  kinds.resize(scene.regions.size());
  if (lane_width == 1) return kinds;
  const auto each = [&](const auto& act) {
    for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
      act(core::RegionId(i), scene.regions[core::RegionId(i)]);
  };
  const bool surfaces = lane_kernels(lane_width).run != nullptr;
  each([&](core::RegionId id, const scene::Region& region) {
    kinds[id] = kind_by_itself(scene, region);
    if (kinds[id] == LaneKind::surfaces && !surfaces) kinds[id] = LaneKind::none;
  });
  const LaneKinds candidates = kinds;
  each([&](core::RegionId id, const scene::Region& region) {
    if (kinds[id] == LaneKind::surfaces && share_in_lanes(scene, region, candidates) <= 0.5)
      kinds[id] = LaneKind::none;
  });
  return kinds;
}

LanePlan::LanePlan(const scene::Scene& scene, int lane_width, LaneKinds kinds)
    : width_(lane_width),
      kinds_(std::move(kinds)),
      scene_(std::make_unique<const LaneScene>(scene, kinds_)) {
  const std::vector<int>& widths = core::lane_widths();
  if (std::find(widths.begin(), widths.end(), lane_width) == widths.end())
    throw core::InternalError("this processor has no lanes of width " + std::to_string(lane_width));
}

LanePlan::~LanePlan() = default;

}  // namespace scintray::transport
