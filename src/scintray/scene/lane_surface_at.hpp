#pragma once
/// Surfaces of a built scene at which photons can be scattered in lanes.

#include <algorithm>

#include "scintray/optics/lane_surface.hpp"
#include "scintray/scene/accelerator.hpp"
#include "scintray/scene/scene.hpp"

namespace scintray::scene {

/// The surface that light which leaves a region through one of its boundary's triangles interacts with.
struct LinkSurface {
  core::SurfaceId id;
  bool own = true;  ///< the region is on its inside
};
inline LinkSurface first_surface(const Interface& interface, bool from_back) {
  const bool has_back = interface.back_surface.has_value(), has_front = interface.front_surface.has_value();
  const bool at_back = from_back ? has_back : !has_front;
  return {at_back ? interface.back_surface : interface.front_surface, at_back == from_back};
}

/// True when one of the regions of an interface is of a birefringent medium.
inline bool touches_birefringent(const Scene& scene, const Interface& interface) {
  const auto birefringent = [&](core::RegionId region) {
    return scene.optics.media[scene.regions[region].medium].birefringent;
  };
  return birefringent(interface.back) || birefringent(interface.front);
}

/// The surface that absorbs light which leaves a region through one of its boundary's triangles, where that
/// is one for lanes: in a dry contact the reflector of the other part.
inline core::SurfaceId absorbing_surface(const Scene& scene, const BoundaryLink& link) {
  const Interface& interface = scene.interfaces[link.interface];
  const LinkSurface first = first_surface(interface, link.from_back);
  if (!interface.gap_medium.has_value() || scene.surfaces[first.id].reflector) return first.id;
  return first.id == interface.back_surface ? interface.front_surface : interface.back_surface;
}

/// The medium behind the surface that light which leaves a region interacts with: that of the gap of a dry
/// contact, else the next region's; none where that is opaque, as indices are then matched.
inline core::MediumId medium_behind_surface(const Scene& scene, const BoundaryLink& link) {
  const Interface& interface = scene.interfaces[link.interface];
  if (interface.gap_medium.has_value()) return interface.gap_medium;
  const core::MediumId next = scene.regions[scene.behind(link)].medium;
  return scene.optics.is_opaque(next) ? core::MediumId() : next;
}

/// The surface at a boundary triangle's interface. Of a reflector from behind the reflector alone; of a dry
/// contact with one the surface of this region's part, the gap, and the reflector. Nothing where photons are
/// scattered one by one: other dry contacts, tables from behind, surfaces that are not for lanes, all next to
/// a birefringent medium, and all where phases are kept.
inline std::optional<optics::LaneSurface> lane_surface_at(const Scene& scene, const BoundaryLink& link) {
  const Interface& interface = scene.interfaces[link.interface];
  if (scene.keeps_phases || touches_birefringent(scene, interface)) return std::nullopt;
  const LinkSurface at = first_surface(interface, link.from_back);
  std::optional<optics::LaneSurface> surface = optics::lane_surface(scene.surfaces[at.id]);
  if (!surface) return std::nullopt;
  if (interface.gap_medium.has_value() && !surface->reflector) {
    const core::SurfaceId beyond = absorbing_surface(scene, link);
    if (!at.own || !beyond.has_value() || (surface->table && surface->table->absorbs())) return std::nullopt;
    const std::optional<optics::LaneSurface> other = optics::lane_surface(scene.surfaces[beyond]);
    if (!other || !other->reflector) return std::nullopt;
    surface->reflector = other->reflector;
    return surface;
  }
  if (at.own) return surface;
  if (surface->table) return std::nullopt;
  if (!surface->reflector) return surface;
  optics::LaneSurface sheet;
  sheet.micro = optics::LaneSurface::Micro::painted;
  sheet.reflector = surface->reflector;
  return sheet;
}

/// Share of the light of a cosine law that is totally reflected at a smooth boundary: 1 - (n2 / n1)^2, in the
/// middle of the wavelengths in use.
inline double totally_reflected(const SceneOptics& optics, core::MediumId here, core::MediumId behind) {
  if (optics.is_opaque(here) || optics.is_opaque(behind)) return 0.0;
  const double middle_nm = optics.media[here].middle_nm();
  const double ratio = optics.index(behind, middle_nm) / optics.index(here, middle_nm);
  return std::max(0.0, 1.0 - ratio * ratio);
}

/// What of a boundary triangle matters to lanes.
struct LaneLink {
  bool smooth = false;  ///< to another medium
  double total = 0.0;   ///< share of diffuse light in the region that is totally reflected there
  bool known = false;   ///< it has a lane_surface_at()
};
inline LaneLink lane_link(const Scene& scene, core::MediumId here, const BoundaryLink& link) {
  LaneLink of;
  of.smooth = link.smooth_to.has_value();
  if (of.smooth) of.total = totally_reflected(scene.optics, here, link.smooth_to);
  of.known = lane_surface_at(scene, link).has_value();
  return of;
}

/// Areas of a region's boundary, mm2.
struct LaneShares {
  double all = 0.0, smooth = 0.0, known = 0.0;  ///< as of LaneLink
  double total = 0.0;                           ///< each times LaneLink::total

  void add(double area_mm2, const LaneLink& link) {
    all += area_mm2;
    if (link.smooth) smooth += area_mm2;
    if (link.known) known += area_mm2;
    total += area_mm2 * link.total;
  }
  bool is_most(double part) const { return part > 0.5 * all; }
};

}  // namespace scintray::scene
