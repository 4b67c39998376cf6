#include <algorithm>
#include <optional>
#include <vector>

#include "scintray/scene/detail/build_steps.hpp"
#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/scene/total_reflection.hpp"

namespace scintray::scene {

namespace {

/// The search for the kinds of all regions. Regions are many and of few kinds: what depends on an interface
/// or a shape alone is computed once.
class KindSearch {
 public:
  explicit KindSearch(const Scene& scene) : scene_(scene), sides_(2 * scene.interfaces.size()) {
    areas_.resize(scene.accelerators.size());
    unfolds_.resize(scene.regions.size());
    kinds_.resize(scene.regions.size());
    without_others_.resize(scene.regions.size());
  }

  bool unfolds(core::RegionId id) const { return unfolds_[id]; }
  core::IdVector<core::RegionId, LaneKind> find() {
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
    LaneLink link;
    double total = 0.0;           ///< share of diffuse light that is totally reflected at it
    bool may_cross = false;       ///< into the next region, where that is in lanes
    Way otherwise = Way::leaves;  ///< where it is not
  };

  template <typename Act>
  void each(const Act& act) const {
    for (std::uint32_t i = 0; i < scene_.regions.size(); ++i) act(core::RegionId(i));
  }

  const Side& side_of(const BoundaryLink& link) {
    Side& side = sides_[2 * link.interface.index() + (link.from_back ? 1 : 0)];
    if (side.known) return side;
    side.known = true;
    const Interface& interface = scene_.interfaces[link.interface];
    const core::RegionId here = link.from_back ? interface.back : interface.front;
    const core::MediumId medium = scene_.regions[here].medium;
    side.link = lane_link(scene_, medium, link);
    side.total = total_share(medium, link);
    const std::optional<optics::LaneSurface> surface = lane_surface_at(scene_, link);
    if (!surface) return side;
    side.may_cross = !surface->reflector && !scene_.reaches_sensor(interface, link.from_back);
    if (surface->reflector || surface->micro != optics::LaneSurface::Micro::smooth)
      side.otherwise = Way::returns;
    return side;
  }
  /// By a cosine law in the middle of the wavelengths in use.
  double total_share(core::MediumId here, const BoundaryLink& link) const {
    if (scene_.optics.is_opaque(here)) return 0.0;
    const double middle_nm = scene_.optics.media[here].middle_nm();
    return 1.0 - std::min(1.0, least_sin2(scene_, total_reflection(scene_, link),
                                          scene_.optics.index(here, middle_nm), middle_nm));
  }
  Way way_of(const BoundaryLink& link) {
    const Side& side = side_of(link);
    if (!side.may_cross) return side.otherwise;
    return kinds_[scene_.behind(link)] == LaneKind::surfaces ? Way::crosses : side.otherwise;
  }
  /// Areas of the triangles around a region, mm2.
  const std::vector<double>& areas_of(const Region& region) {
    std::vector<double>& areas = areas_[region.accelerator];
    const Boundary& boundary = scene_.accelerator(region).boundary();
    if (areas.empty())
      for (std::size_t i = 0; i < boundary.size(); ++i) areas.push_back(area_of(boundary.triangle(i)));
    return areas;
  }

  /// By the region's own boundary.
  void set_by_itself(core::RegionId id) {
    const Region& region = scene_.regions[id];
    const Accelerator& accelerator = scene_.accelerator(region);
    if (scene_.optics.media[region.medium].birefringent) return;
    const bool in_lanes =
        !region.rotated && (accelerator.uses_planes() || accelerator.is_convex_body() || region.thin_gaps);
    const bool is_box = accelerator.boundary().is_box;
    if (!in_lanes && !is_box) return;
    const BoundaryLink* const links = scene_.links_of(region);
    const std::vector<double>& areas = areas_of(region);
    LaneShares shares;
    double total = 0.0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
      const Side& side = side_of(links[i]);
      shares.add(areas[i], side.link);
      total += areas[i] * side.total;
    }
    unfolds_[id] = is_box && shares.is_most(total);
    if (!in_lanes) return;
    // With few total reflections in a row, entering and leaving the lanes costs more than they save.
    if (shares.is_most(shares.smooth) && shares.is_most(shares.total) && !region.thin_gaps)
      without_others_[id] = LaneKind::smooth;
    kinds_[id] = !region.curved && shares.is_most(shares.known) ? LaneKind::surfaces : without_others_[id];
  }

  /// Whether light stays in lanes for long: at most of the boundary of its region. Into thin gaps it has to
  /// come as well. From a region with a kernel of its own most of it has to go on in lanes.
  bool stays_in_lanes(core::RegionId id) {
    constexpr double kMost = 0.6;  // more than of a layer of grease between crystal and sensor
    const Region& region = scene_.regions[id];
    const BoundaryLink* const links = scene_.links_of(region);
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

  const Scene& scene_;
  std::vector<Side> sides_;  ///< two per interface
  core::IdVector<core::AcceleratorId, std::vector<double>> areas_;
  core::IdVector<core::RegionId, LaneKind> kinds_;
  core::IdVector<core::RegionId, char> unfolds_;
  core::IdVector<core::RegionId, LaneKind> without_others_;  ///< where light that leaves one leaves the lanes
};

}  // namespace

void set_lane_kinds(Scene& scene) {
  KindSearch search(scene);
  const core::IdVector<core::RegionId, LaneKind> kinds = search.find();
  bool some_unfold = false;
  for (std::uint32_t i = 0; i < scene.regions.size(); ++i) {
    Region& region = scene.regions[core::RegionId(i)];
    region.lanes = kinds[core::RegionId(i)];
    region.unfolds = search.unfolds(core::RegionId(i));
    some_unfold = some_unfold || region.unfolds;
  }
  if (!some_unfold) return;
  for (std::uint32_t i = 0; i < scene.interfaces.size(); ++i)
    for (const bool from_back : {false, true})
      scene.total_reflections.push_back(
          total_reflection(scene, {core::InterfaceId(i), core::MediumId(), from_back}));
}

}  // namespace scintray::scene
