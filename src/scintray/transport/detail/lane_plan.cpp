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

/// The search for the kernels of all regions. Regions are many and of few kinds: what depends on an interface
/// or a shape alone is computed once.
class KindSearch {
 public:
  KindSearch(const scene::Scene& scene, bool surfaces)
      : scene_(scene), surfaces_(surfaces), sides_(2 * scene.interfaces.size()) {
    areas_.resize(scene.accelerators.size());
    kinds_.resize(scene.regions.size());
    without_others_.resize(scene.regions.size());
  }

  LaneKinds find() {
    each([&](core::RegionId id) { set_by_itself(id); });
    // Each region that is left out may be one into which light of others goes.
    for (bool changed = true; changed;) {
      changed = false;
      each([&](core::RegionId id) {
        if (kinds_[id] != LaneKind::surfaces || stays_in_lanes(id)) return;
        kinds_[id] = without_others_[id];
        changed = true;
      });
    }
    return kinds_;
  }

 private:
  /// Ways of light that reaches an interface in lanes.
  enum class Way {
    leaves,
    returns,  ///< by a rough face or a reflector, the most of it
    crosses,  ///< it may go on in the next region
  };
  /// One side of an interface.
  struct Side {
    bool known = false;
    scene::LaneLink link;
    bool may_cross = false;       ///< into the next region, where that is in lanes
    Way otherwise = Way::leaves;  ///< where it is not
  };

  template <typename Act>
  void each(const Act& act) const {
    for (std::uint32_t i = 0; i < scene_.regions.size(); ++i) act(core::RegionId(i));
  }

  const Side& side_of(const scene::BoundaryLink& link) {
    Side& side = sides_[2 * link.interface.index() + (link.from_back ? 1 : 0)];
    if (side.known) return side;
    side.known = true;
    const scene::Interface& interface = scene_.interfaces[link.interface];
    const core::RegionId here = link.from_back ? interface.back : interface.front;
    side.link = scene::lane_link(scene_, scene_.regions[here].medium, link);
    const std::optional<optics::LaneSurface> surface = scene::lane_surface_at(scene_, link);
    if (!surface) return side;
    side.may_cross = !surface->reflector && !reaches_sensor(scene_, interface, link.from_back);
    if (surface->reflector || surface->micro != optics::LaneSurface::Micro::smooth)
      side.otherwise = Way::returns;
    return side;
  }
  Way way_of(const scene::BoundaryLink& link) {
    const Side& side = side_of(link);
    if (!side.may_cross) return side.otherwise;
    return kinds_[region_behind(scene_, link)] == LaneKind::surfaces ? Way::crosses : side.otherwise;
  }
  /// Areas of the triangles around a region, mm2.
  const std::vector<double>& areas_of(const scene::Region& region) {
    std::vector<double>& areas = areas_[region.accelerator];
    const scene::Boundary& boundary = scene_.accelerator(region).boundary();
    if (areas.empty())
      for (std::size_t i = 0; i < boundary.size(); ++i) areas.push_back(scene::area_of(boundary.triangle(i)));
    return areas;
  }

  /// By the region's own boundary.
  void set_by_itself(core::RegionId id) {
    const scene::Region& region = scene_.regions[id];
    if (!region.in_lanes) return;
    const scene::BoundaryLink* const links = scene_.links_of(region);
    const std::vector<double>& areas = areas_of(region);
    scene::LaneShares shares;
    for (std::size_t i = 0; i < areas.size(); ++i) shares.add(areas[i], side_of(links[i]).link);
    // With few total reflections in a row, entering and leaving the lanes costs more than they save.
    if (shares.is_most(shares.smooth) && shares.is_most(shares.total) && !region.thin_gaps)
      without_others_[id] = LaneKind::smooth;
    kinds_[id] = surfaces_ && !region.curved && shares.is_most(shares.known) ? LaneKind::surfaces
                                                                             : without_others_[id];
  }

  /// Whether light stays in lanes for long: at most of the boundary of its region. Into thin gaps it has to
  /// come as well. From a region with a kernel of its own most of it has to go on in lanes.
  bool stays_in_lanes(core::RegionId id) {
    constexpr double kMost = 0.6;  // more than of a layer of grease between crystal and sensor
    const scene::Region& region = scene_.regions[id];
    const scene::BoundaryLink* const links = scene_.links_of(region);
    const std::vector<double>& areas = areas_of(region);
    // Of planes that lead to several regions.
    const std::vector<std::uint32_t>& mixed = scene_.accelerator(region).boundary().plane_triangles;
    double all = 0.0, returns = 0.0, crosses = 0.0;
    for (std::uint32_t i = 0; i < areas.size(); ++i) {
      all += areas[i];
      if (std::find(mixed.begin(), mixed.end(), i) != mixed.end()) continue;
      const Way way = way_of(links[i]);
      if (way == Way::returns) returns += areas[i];
      if (way == Way::crosses) crosses += areas[i];
    }
    if (without_others_[id] != LaneKind::none) return crosses > kMost * all;
    return returns + crosses > kMost * all && (crosses > 0.0 || !region.thin_gaps);
  }

  const scene::Scene& scene_;
  bool surfaces_;            ///< there is a kernel for LaneKind::surfaces
  std::vector<Side> sides_;  ///< two per interface
  core::IdVector<core::AcceleratorId, std::vector<double>> areas_;
  LaneKinds kinds_;
  LaneKinds without_others_;  ///< where light that leaves a region leaves the lanes
};

}  // namespace

LaneKinds lane_kinds(const scene::Scene& scene, int lane_width) {
  LaneKinds none;
  none.resize(scene.regions.size());
  return lane_width == 1 ? none : KindSearch(scene, lane_kernels(lane_width).run != nullptr).find();
}

LanePlan::LanePlan(const scene::Scene& scene, int lane_width, LaneKinds kinds)
    : width_(lane_width), kinds_(std::move(kinds)), scene_(std::make_unique<const LaneScene>(scene, kinds_)) {
  const std::vector<int>& widths = core::lane_widths();
  if (std::find(widths.begin(), widths.end(), lane_width) == widths.end())
    throw core::InternalError("this processor has no lanes of width " + std::to_string(lane_width));
}

LanePlan::~LanePlan() = default;

}  // namespace scintray::transport
