#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

InterfaceIndex indices_at(const scene::Scene& scene, const scene::Interface& interface,
                          double wavelength_nm) {
  const scene::SceneOptics& optics = scene.optics;
  const core::MediumId back = scene.regions[interface.back].medium;
  const core::MediumId front = scene.regions[interface.front].medium;
  InterfaceIndex index;
  index.dry = interface.gap_medium.has_value();
  // An opaque part has no index: light enters it with matched indices, from the gap where there is one.
  const auto at = [&](core::MediumId own, core::MediumId other) {
    const core::MediumId outside = index.dry ? interface.gap_medium : other;
    return optics.index(optics.is_opaque(own) ? outside : own, wavelength_nm);
  };
  index.back = at(back, front);
  index.front = at(front, back);
  if (index.dry) index.gap = optics.index(interface.gap_medium, wavelength_nm);
  const auto [birefringent_back, birefringent_front] = birefringent_sides(scene, interface, wavelength_nm);
  index.birefringent_back = birefringent_back;
  index.birefringent_front = birefringent_front;
  return index;
}

/// Conditions of incidence at one of the interface's surfaces.
struct SurfaceApproach {
  const scene::Scene& scene;
  const scene::Interface& interface;
  bool at_back = false;  ///< the back region's surface, else the front region's
  optics::Side side = optics::Side::inside;
  const core::Vec3& outward;  ///< of unit length, out of the region of the surface
  InterfaceIndex& index;      ///< at the photon's wavelength, updated when it is shifted
};

/// Interaction with a surface in which the photon's wavelength may change.
[[gnu::noinline, gnu::cold]] optics::SurfaceOutcome interact_with_shift(const SurfaceApproach& at,
                                                                        source::Photon& photon,
                                                                        core::Rng& rng,
                                                                        source::PhotonRecords* records) {
  const core::SurfaceId id = at.at_back ? at.interface.back_surface : at.interface.front_surface;
  optics::ShiftingLight light;
  light.wavelength_nm = photon.wavelength_nm;
  const auto index_at = [&](double wavelength_nm) {
    at.index = indices_at(at.scene, at.interface, wavelength_nm);
    return at.index.around(at.at_back);
  };
  light.index = index_at;
  const optics::SurfaceOutcome outcome = at.scene.surfaces[id].interact(
      photon.ray, at.side, at.outward, light, rng, records ? records->reflection_log() : nullptr);
  photon.wavelength_nm = light.wavelength_nm;
  photon.time_ns += light.delay_ns;
  if (records && light.count.absorbed > 0) records->shifts_of(id) += light.count;
  return outcome;
}

}  // namespace

BirefringentSides find_birefringent_sides(const scene::Scene& scene, const scene::Interface& interface,
                                          double wavelength_nm) {
  const scene::SceneOptics& optics = scene.optics;
  const core::MediumId back = scene.regions[interface.back].medium;
  const core::MediumId front = scene.regions[interface.front].medium;
  const auto at = [&](core::MediumId own, core::MediumId other) -> const optics::BirefringentOptics* {
    if (!optics.is_opaque(own)) return optics.birefringent_at(own, wavelength_nm);
    if (interface.gap_medium.has_value() || optics.is_opaque(other)) return nullptr;
    return optics.birefringent_at(other, wavelength_nm);
  };
  return {at(back, front), at(front, back)};
}

InterfaceOutcome interact_at_interface(const InterfaceApproach& at, source::Photon& photon, core::Rng& rng,
                                       source::PhotonRecords* records) {
  const scene::Interface& interface = at.interface;
  const bool has_back = interface.back_surface.has_value(), has_front = interface.front_surface.has_value();
  bool at_back = at.from_back ? has_back : !has_front;  // which of the two surfaces comes next
  bool came_from_back = at.from_back;
  InterfaceIndex index = at.index;
  for (;;) {
    const core::SurfaceId id = at_back ? interface.back_surface : interface.front_surface;
    const optics::Surface& surface = at.scene.surfaces[id];
    // A surface's inside is the region of the part it belongs to.
    const core::Vec3 outward = at_back ? at.normal : core::Vec3(-at.normal);
    const optics::Side side = came_from_back == at_back ? optics::Side::inside : optics::Side::outside;
    const optics::SurfaceOutcome outcome =
        surface.shifts()
            ? interact_with_shift({at.scene, interface, at_back, side, outward, index}, photon, rng, records)
            : surface.interact(photon.ray,
                               {side, outward, index.around(at_back), photon.wavelength_nm,
                                records ? records->reflection_log() : nullptr},
                               rng);
    if (outcome == optics::SurfaceOutcome::absorbed) return {false, id};
    if (outcome == optics::SurfaceOutcome::inside) return {!at_back, core::SurfaceId::none()};
    if (!index.dry) return {at_back, core::SurfaceId::none()};
    came_from_back = at_back;  // in the gap, between this surface and the other
    at_back = !at_back;
  }
}

}  // namespace scintray::transport
