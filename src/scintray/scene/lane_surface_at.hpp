#pragma once
/// Surfaces of a built scene at which photons can be scattered in lanes.

#include "scintray/optics/lane_surface.hpp"
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

/// The surface at a boundary triangle's interface; nothing where photons are scattered one by one: dry
/// contacts, reflectors from behind, and surfaces that are not for lanes.
inline std::optional<optics::LaneSurface> lane_surface_at(const Scene& scene, const BoundaryLink& link) {
  const Interface& interface = scene.interfaces[link.interface];
  if (interface.gap_medium.has_value()) return std::nullopt;
  const LinkSurface at = first_surface(interface, link.from_back);
  std::optional<optics::LaneSurface> surface = optics::lane_surface(scene.surfaces[at.id]);
  if (surface && surface->reflector && !at.own) return std::nullopt;
  return surface;
}

}  // namespace scintray::scene
