#include <algorithm>
#include <optional>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

/// Kernels for a region by its own boundary.
struct Kernels {
  LaneKind best = LaneKind::none;
  LaneKind without_others = LaneKind::none;  ///< where light that leaves it leaves the lanes
};

Kernels kernels_for(const scene::Scene& scene, const scene::Region& region, bool surfaces) {
  if (!region.in_lanes) return {};
  const scene::LaneShares shares = scene::lane_shares(scene, region);
  Kernels kernels;
  // With few total reflections in a row, entering and leaving the lanes costs more than they save.
  if (shares.smooth > 0.5 && shares.total > 0.5 && !region.thin_gaps)
    kernels.without_others = LaneKind::smooth;
  kernels.best =
      surfaces && !region.curved && shares.known > 0.5 ? LaneKind::surfaces : kernels.without_others;
  return kernels;
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

/// Whether light stays in lanes for long: at most of the boundary of its region. Into thin gaps it has to
/// come as well. From a region with a kernel of its own most of it has to go on in lanes.
bool stays_in_lanes(const scene::Scene& scene, const scene::Region& region, const LaneKinds& kinds,
                    bool has_own_kernel) {
  constexpr double kMost = 0.6;  // more than of a layer of grease between crystal and sensor
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
  if (has_own_kernel) return crosses > kMost * all;
  return returns + crosses > kMost * all && (crosses > 0.0 || !region.thin_gaps);
}

}  // namespace

LaneKinds lane_kinds(const scene::Scene& scene, int lane_width) {
  LaneKinds kinds, without_others;
  kinds.resize(scene.regions.size());
  without_others.resize(scene.regions.size());
  if (lane_width == 1) return kinds;
  const auto each = [&](const auto& act) {
    for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
      act(core::RegionId(i), scene.regions[core::RegionId(i)]);
  };
  const bool surfaces = lane_kernels(lane_width).run != nullptr;
  each([&](core::RegionId id, const scene::Region& region) {
    const Kernels kernels = kernels_for(scene, region, surfaces);
    kinds[id] = kernels.best;
    without_others[id] = kernels.without_others;
  });
  // Each region that is left out may be one into which light of others goes.
  for (bool changed = true; changed;) {
    changed = false;
    each([&](core::RegionId id, const scene::Region& region) {
      const bool has_own_kernel = without_others[id] != LaneKind::none;
      if (kinds[id] != LaneKind::surfaces || stays_in_lanes(scene, region, kinds, has_own_kernel)) return;
      kinds[id] = without_others[id];
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
