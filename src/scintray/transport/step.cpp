#include "scintray/transport/step.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"
#include "scintray/source/photon_optics.hpp"
#include "scintray/transport/detail/propagation_states.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

/// Propagation through total reflections until another event. Inlined: it is part of every step.
template <typename State>
[[gnu::always_inline]] inline Propagation propagate_as(const scene::Scene& scene, source::Photon& photon,
                                                       const PropagationLimits& limits) {
  const scene::Region& region = scene.regions[photon.region];
  const scene::BoundaryLink* const links = scene.links_of(region);
  const double attenuation = photon.optics.absorption_per_mm + photon.optics.scattering_per_mm;
  State state(scene, region, photon);
  CriticalAngle critical(scene, photon);
  Propagation propagation;
  for (;;) {
    if constexpr (State::kUnfolds) propagation.segments += state.pass_reflections(limits);
    ++propagation.segments;
    const Wall wall = state.next_wall();
    propagation.resolved += wall.resolved ? 1 : 0;
    propagation.triangle = wall.triangle;
    if (wall.triangle == scene::kNoTriangle) [[unlikely]] {
      propagation.end = attenuation > 0.0 ? PropagationEnd::bulk : PropagationEnd::escape;
      break;
    }
    const double depth = attenuation * wall.distance_mm;
    if (depth > state.depth_left()) {
      propagation.end = PropagationEnd::bulk;
      break;
    }
    state.move(wall.distance_mm, depth);
    propagation.end = PropagationEnd::boundary;
    const core::MediumId medium = links[wall.triangle].smooth_to;
    if (!medium.has_value()) break;
    propagation.cosine = state.incidence(wall);
    if (!totally_reflected(propagation.cosine, critical.sin2(medium))) break;

    state.reflect_at(wall, propagation.cosine);
    propagation.end = PropagationEnd::total;
    if (!state.allowed_by(limits)) break;
    if (limits.passed) [[unlikely]] {
      state.store(photon);
      limits.passed(photon, total_reflection(scene, photon, wall.triangle, propagation.cosine));
    }
    if (!state.goes_on()) break;
    state.turn();
  }
  state.store(photon);
  return propagation;
}

[[gnu::noinline]] void go_on_with_embree(const scene::Scene& scene, source::Photon& photon,
                                         const PropagationLimits& limits, Propagation& propagation) {
  const Propagation first = propagation;
  propagation = propagate_as<EmbreePropagation>(scene, photon, limits);
  propagation.segments += first.segments;
  propagation.resolved += first.resolved;
}

[[gnu::noinline]] Propagation propagate_between_curves(const scene::Scene& scene, source::Photon& photon,
                                                       const PropagationLimits& limits) {
  return propagate_as<CurvedPropagation>(scene, photon, limits);
}

[[gnu::noinline]] Propagation propagate_in_box(const scene::Scene& scene, source::Photon& photon,
                                               const PropagationLimits& limits) {
  return propagate_as<UnfoldedPropagation>(scene, photon, limits);
}

/// Propagation of the photon through its region, up to the next event. Depends on its arguments alone.
Propagation propagate(const scene::Scene& scene, source::Photon& photon, const PropagationLimits& limits) {
  if (scene.regions[photon.region].unfolds) return propagate_in_box(scene, photon, limits);
  const bool curved = scene.regions[photon.region].curved;
  Propagation propagation = curved ? propagate_between_curves(scene, photon, limits)
                                   : propagate_as<StoredPropagation>(scene, photon, limits);
  if (!curved && propagation.end == PropagationEnd::total &&
      limits.allow(photon.interactions, photon.time_ns))
    go_on_with_embree(scene, photon, limits, propagation);
  return propagation;
}

void interact_in_bulk(const scene::Scene& scene, core::MediumId id, source::Photon& photon, core::Rng& rng,
                      source::PhotonRecords* records, Step& result) {
  const scene::MediumRecord& medium = scene.optics.media[id];
  const double absorption = photon.optics.absorption_per_mm;
  const double total = absorption + photon.optics.scattering_per_mm;
  if (rng.uniform() * total < absorption) {
    if (medium.shifts && shift_in_bulk(scene, id, photon, rng, records)) {
      photon.optical_depth = core::sample_exponential(rng);
      result.event = core::StepEvent::re_emitted;
    } else {
      result.event = core::StepEvent::absorbed_in_medium;
      result.medium = id;
    }
    return;
  }
  const bool by_particles = medium.particles && scatter_at_particles(scene, id, photon, rng);
  if (!by_particles && !(medium.birefringent && source::scatter(scene, photon, rng))) {
    if (medium.scattering == optics::ScatteringKind::rayleigh)
      scatter_rayleigh(photon.ray, rng);
    else
      optics::scatter_isotropic(photon.ray, rng);
  }
  photon.optical_depth = core::sample_exponential(rng);
  ++photon.scatterings;
  result.event = core::StepEvent::scattered;
}

/// Medium and angle in which light reaches a sensor.
struct Arrival {
  double index = 1.0;   ///< refractive index
  double cosine = 1.0;  ///< of the angle to the normal
};

/// Conversion probability with the efficiency at the place of the photon.
[[gnu::noinline, gnu::cold]] double at_place(const scene::Scene& scene, const scene::Interface& interface,
                                             const source::Photon& photon, bool from_back,
                                             double probability) {
  const core::PartId part = from_back ? interface.front_sensor_part : interface.back_sensor_part;
  const core::SensorId sensor = from_back ? interface.front_sensor : interface.back_sensor;
  return probability *
         scene.sensor_frame(interface, part).factor(*scene.sensors[sensor].over_face, photon.position.vec());
}

/// The end of a photon at the sensor of an interface: converted or not.
void reach_sensor(const scene::Scene& scene, const scene::Interface& interface, const source::Photon& photon,
                  const Arrival& arrival, Step& result) {
  const core::SensorId id = result.from_back ? interface.front_sensor : interface.back_sensor;
  const double sine = std::sqrt(std::max(0.0, 1.0 - arrival.cosine * arrival.cosine));
  double probability = scene.sensors[id].conversion_probability(photon.wavelength_nm, arrival.index * sine);
  if (scene.sensors[id].over_face) [[unlikely]]
    probability = at_place(scene, interface, photon, result.from_back, probability);
  result.event =
      photon.conversion_draw < probability ? core::StepEvent::detected : core::StepEvent::not_detected;
  result.sensor_part = result.from_back ? interface.front_sensor_part : interface.back_sensor_part;
}

/// Light absorbed by a surface at an interface: converted by a sensor that converts such light, or lost.
void absorb_at_surface(const scene::Scene& scene, const scene::Interface& interface,
                       const source::Photon& photon, Step& result) {
  result.event = core::StepEvent::absorbed_at_surface;
  const core::SensorId id = result.from_back ? interface.front_sensor : interface.back_sensor;
  if (!id.has_value() || !scene.sensors[id].converts_absorbed()) return;
  reach_sensor(scene, interface, photon, {photon.optics.index, result.cos_before}, result);
}

/// Photon and step, of which all but the event is known, when light has passed an interface.
/// @param there  refractive index behind it
inline void cross(const scene::Scene& scene, const scene::Interface& interface, double there,
                  source::Photon& photon, Step& result) {
  const core::RegionId before = photon.region;
  photon.region = result.from_back ? interface.front : interface.back;
  const scene::Region& entered = scene.regions[photon.region];
  photon.on_triangle =
      entered.thin_gaps ? scene.twin(scene.regions[before], result.triangle) : scene::kNoTriangle;
  const core::MediumId medium = entered.medium;
  photon.optics = scene.optics.at(medium, photon.wavelength_nm);
  if (scene.reaches_sensor(interface, result.from_back)) {
    reach_sensor(scene, interface, photon, {there, result.cos_after}, result);
  } else if (scene.optics.is_opaque(medium)) {
    result.event = core::StepEvent::absorbed_in_medium;
    result.medium = medium;
  } else {
    result.event = core::StepEvent::transmitted;
  }
}

void set_place(const scene::BoundaryLink& link, const BoundaryPlace& at, const source::Photon& photon,
               Step& step) {
  step.interface = link.interface;
  step.triangle = at.triangle;
  step.from_back = link.from_back;
  step.cos_before = at.cos_before;
  step.region = photon.region;
}

void interact_at_boundary(const scene::Scene& scene, std::uint32_t triangle, source::Photon& photon,
                          core::Rng& rng, source::PhotonRecords* records, Step& result) {
  const scene::Region& region = scene.regions[photon.region];
  const scene::SceneOptics& optics = scene.optics;
  const scene::BoundaryLink link = scene.link(region, triangle);
  const scene::Interface& interface = scene.interfaces[link.interface];
  const core::Vec3 outward = scene.normal_at(region, triangle, photon.position);
  set_place(link, {triangle, std::abs(photon.ray.direction.dot(outward))}, photon, result);
  const double here = photon.optics.index, there = index_behind(scene, link, photon);
  const bool dry = interface.gap_medium.has_value();
  const double gap = dry ? optics.index(interface.gap_medium, photon.wavelength_nm) : 0.0;
  if (!interface.plain || here != there) ++photon.interactions;

  bool crossed;
  if (interface.plain) {
    crossed = optics::interact_at_facet(photon.ray, -outward, here, there, rng);
  } else {
    const core::Vec3 normal = link.from_back ? outward : core::Vec3(-outward);
    const double back = link.from_back ? here : there, front = link.from_back ? there : here;
    const double before_nm = photon.wavelength_nm;
    const BirefringentSides sides = birefringent_sides(scene, interface, before_nm);
    const InterfaceApproach approach{
        scene, interface, link.from_back, normal, {back, front, gap, dry, sides.back, sides.front}};
    const InterfaceOutcome outcome = interact_at_interface(approach, photon, rng, records);
    if (photon.wavelength_nm != before_nm) photon.optics = optics.at(region.medium, photon.wavelength_nm);
    if (outcome.absorbed_by.has_value()) {
      result.surface = outcome.absorbed_by;
      return absorb_at_surface(scene, interface, photon, result);
    }
    crossed = outcome.in_front == link.from_back;
  }
  result.cos_after = std::abs(photon.ray.direction.dot(outward));
  if (crossed) {
    cross(scene, interface, there, photon, result);
  } else {
    if (region.thin_gaps) photon.on_triangle = triangle;
    result.event = core::StepEvent::reflected;
  }
}

}  // namespace

double index_behind(const scene::Scene& scene, const scene::BoundaryLink& link,
                    const source::Photon& photon) {
  const core::MediumId medium = medium_behind(scene, link);
  return medium.has_value() ? scene.optics.index(medium, photon.wavelength_nm) : photon.optics.index;
}

Step cross_boundary(const scene::Scene& scene, const BoundaryPlace& at, source::Photon& photon) {
  const scene::Region& region = scene.regions[photon.region];
  const scene::BoundaryLink& link = scene.link(region, at.triangle);
  Step result;
  result.segments = 0;
  set_place(link, at, photon, result);
  result.cos_after =
      std::abs(photon.ray.direction.dot(scene.normal_at(region, at.triangle, photon.position)));
  cross(scene, scene.interfaces[link.interface], index_behind(scene, link, photon), photon, result);
  return result;
}

Step absorb_at_boundary(const scene::Scene& scene, const BoundaryPlace& at, core::SurfaceId by,
                        const source::Photon& photon) {
  const scene::BoundaryLink& link = scene.link(scene.regions[photon.region], at.triangle);
  Step result;
  result.segments = 0;
  set_place(link, at, photon, result);
  result.surface = by;
  absorb_at_surface(scene, scene.interfaces[link.interface], photon, result);
  return result;
}

Step step(const scene::Scene& scene, source::Photon& photon, core::Rng& rng, const PropagationLimits& limits,
          source::PhotonRecords* records) {
  return end_of_step(scene, propagate(scene, photon, limits), photon, rng, records);
}

Step interact_at(const scene::Scene& scene, std::uint32_t triangle, source::Photon& photon, core::Rng& rng) {
  Propagation there;
  there.end = PropagationEnd::boundary;
  there.triangle = triangle;
  return end_of_step(scene, there, photon, rng, nullptr);
}

Step end_of_step(const scene::Scene& scene, const Propagation& propagation, source::Photon& photon,
                 core::Rng& rng, source::PhotonRecords* records) {
  // All that follows writes into this one result: copying what was just written byte by byte would stall
  // until the writes are complete.
  const core::RegionId from = photon.region;
  Step result;
  switch (propagation.end) {
    case PropagationEnd::bulk:
      photon.on_triangle = scene::kNoTriangle;
      advance(photon,
              photon.optical_depth / (photon.optics.absorption_per_mm + photon.optics.scattering_per_mm));
      interact_in_bulk(scene, scene.regions[from].medium, photon, rng, records, result);
      break;
    case PropagationEnd::escape:
      result.event = core::StepEvent::escaped;
      break;
    case PropagationEnd::boundary:
      interact_at_boundary(scene, propagation.triangle, photon, rng, records, result);
      break;
    case PropagationEnd::total:
      result = total_reflection(scene, photon, propagation.triangle, propagation.cosine);
      break;
  }
  result.region = from;
  result.segments = propagation.segments;
  result.resolved = propagation.resolved;
  if (scene.optics.birefringent.empty()) [[likely]]
    return result;
  if (!core::is_final(result.event)) source::take_mode(scene, photon, rng);
  return result;
}

}  // namespace scintray::transport
