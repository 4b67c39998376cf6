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
  if (shares.smooth > 0.5 && shares.total > 0.5 && !region.thin_gaps && !std::getenv("TOG"))
    return LaneKind::smooth;
  return surfaces ? LaneKind::surfaces : LaneKind::none;
}

/// Ways of light that reaches a boundary in lanes.
enum class InLanes {
  leaves,
  returns,  ///< by a rough face or a reflector, the most of it
  crosses,  ///< it may go on in the next region
};

InLanes in_lanes_at(const scene::Scene& scene, const scene::BoundaryLink& link, const LaneKinds& kinds) {
  const std::optional<optics::LaneSurface> surface = scene::lane_surface_at(scene, link);
  if (!surface) return InLanes::leaves;
  if (surface->reflector) return InLanes::returns;
  const scene::Interface& interface = scene.interfaces[link.interface];
  if (kinds[link.from_back ? interface.front : interface.back] == LaneKind::surfaces &&
      !reaches_sensor(scene, interface, link.from_back))
    return InLanes::crosses;
  return surface->micro == optics::LaneSurface::Micro::smooth ? InLanes::leaves : InLanes::returns;
}

/// Whether light that is in a region stays in lanes for long: from most of the boundary. Where there are thin
/// gaps it has to come in through some of it as well.
bool stays_in_lanes(const scene::Scene& scene, const scene::Region& region, const LaneKinds& kinds) {
  const scene::BoundaryLink* const links = scene.links_of(region);
  const scene::Boundary& boundary = scene.accelerator(region).boundary();
  const auto& mixed = boundary.plane_triangles;  // of planes that lead to several regions
  double all = 0.0, returns = 0.0, crosses = 0.0;
  for (std::uint32_t i = 0; i < boundary.size(); ++i) {
    const double area = scene::area_of(boundary.triangle(i));
    all += area;
    if (std::find(mixed.begin(), mixed.end(), i) != mixed.end()) continue;
    const InLanes way = in_lanes_at(scene, links[i], kinds);
    if (way == InLanes::returns) returns += area;
    if (way == InLanes::crosses) crosses += area;
  }
  return returns + crosses > 0.6 * all && (crosses > 0.0 || !region.thin_gaps);
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
  // Each region that is left out may be one that others need.
  for (bool changed = true; changed;) {
    changed = false;
    each([&](core::RegionId id, const scene::Region& region) {
      if (kinds[id] != LaneKind::surfaces || stays_in_lanes(scene, region, kinds)) return;
      kinds[id] = LaneKind::none;
      changed = true;
    });
  }
  return kinds;
}

LanePlan::LanePlan(const scene::Scene& scene, int lane_width, LaneKinds kinds)
    : width_(lane_width), kinds_(std::move(kinds)), scene_(std::make_unique<const LaneScene>(scene, kinds_)) {
  const std::vector<int>& widths = core::lane_widths();
  if (std::find(widths.begin(), widths.end(), lane_width) == widths.end())
    throw core::InternalError("this processor has no lanes of width " + std::to_string(lane_width));
}

LanePlan::~LanePlan() = default;

}  // namespace scintray::transport
