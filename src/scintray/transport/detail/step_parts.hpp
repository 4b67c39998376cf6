#pragma once
/// The parts of a step: propagation to its end, and the event there, in the bulk of a medium or at an
/// interface.

#include <optional>

#include "scintray/scene/total_reflection.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

enum class PropagationEnd {
  bulk,      ///< absorption or scattering in the medium
  escape,    ///< the photon leaves the scene
  boundary,  ///< the photon is at a boundary, whose interaction follows
  total,     ///< the photon was totally reflected, and the limits are reached
};

/// End of a propagation, and the segments up to it.
struct Propagation {
  PropagationEnd end = PropagationEnd::escape;
  std::uint32_t triangle = scene::kNoTriangle;  ///< at a boundary: of the region's accelerator
  double cosine = 0.0;                          ///< of incidence, at a smooth boundary
  std::uint32_t segments = 0;                   ///< straight segments
  std::uint32_t resolved = 0;                   ///< ray queries that the exact query resolved
};

/// sin^2 of the critical angle towards a medium; above 1 without total reflection, as for no medium.
inline double critical_sin2(const scene::Scene& scene, core::MediumId medium, const source::Photon& photon) {
  if (!medium.has_value() || scene.optics.is_opaque(medium)) return scene::kNeverTotal;
  return scene::critical_sin2(photon.optics.index, scene.optics.index(medium, photon.wavelength_nm));
}

/// critical_sin2() of a photon towards one medium after another, of which most are as the last.
class CriticalAngle {
 public:
  CriticalAngle(const scene::Scene& scene, const source::Photon& photon)
      : scene_(scene), photon_(photon), sin2_(critical_sin2(scene, medium_, photon)) {}

  double sin2(core::MediumId medium) {
    if (medium != medium_) {
      medium_ = medium;
      sin2_ = critical_sin2(scene_, medium, photon_);
    }
    return sin2_;
  }

 private:
  const scene::Scene& scene_;
  const source::Photon& photon_;
  core::MediumId medium_;
  double sin2_;
};

/// The medium of index_behind(); none: that of the photon.
inline core::MediumId medium_behind(const scene::Scene& scene, const scene::BoundaryLink& link) {
  const core::MediumId next = scene.regions[scene.behind(link)].medium;
  return scene.optics.is_opaque(next) ? scene.interfaces[link.interface].gap_medium : next;
}

/// Refractive index behind a boundary of the photon's region, at its wavelength: of the next region, or for
/// an opaque one that of the gap of a dry contact, else the photon's own, as there is no Fresnel reflection
/// where light enters an opaque part: its reflection is defined by its surface.
double index_behind(const scene::Scene& scene, const scene::BoundaryLink& link, const source::Photon& photon);

/// A photon at a boundary of its region.
struct BoundaryPlace {
  std::uint32_t triangle = scene::kNoTriangle;  ///< of the region's boundary
  double cos_before = 0.0;                      ///< as of Step
};
/// The step of a photon transmitted by the surface: into the next region, or its sensor. The photon's
/// direction is that after the interaction, its region still the old one. Without segments.
Step cross_boundary(const scene::Scene& scene, const BoundaryPlace& at, source::Photon& photon);
/// The step of a photon absorbed by a surface. Without segments.
Step absorb_at_boundary(const scene::Scene& scene, const BoundaryPlace& at, core::SurfaceId by,
                        const source::Photon& photon);

/// Box (world, mm) around all that light in the ambient medium could meet; nothing where it is not known, as
/// exact round faces reach beyond the corners of their triangles.
std::optional<Eigen::AlignedBox3d> ambient_bounds(const scene::Scene& scene);
/// True when light that a step has taken out of a region meets nothing more: it is in an ambient medium
/// without absorption and scattering, and all that it could meet lies behind the plane through which it left.
/// @param bounds  ambient_bounds()
bool leaves_the_scene(const scene::Scene& scene, const std::optional<Eigen::AlignedBox3d>& bounds,
                      const source::Photon& photon, const Step& taken);
/// The step of a photon that was last reflected in lanes, which count its segments.
inline Step reflected_in_lanes() {
  Step step;
  step.event = core::StepEvent::reflected;
  step.segments = 0;
  return step;
}
/// The step of light that leaves_the_scene().
inline Step step_out_of_scene() {
  Step step;
  step.event = core::StepEvent::escaped;
  step.region = scene::kAmbientRegion;
  return step;
}

/// Outcome at an interface: the region that the ray enters, or the surface that absorbed it.
struct InterfaceOutcome {
  bool in_front = false;
  core::SurfaceId absorbed_by;
};

/// Indices on the two sides of an interface and in the gap of a dry contact, at one wavelength.
struct InterfaceIndex {
  double back = 1.0, front = 1.0, gap = 0.0;
  bool dry = false;
  const optics::BirefringentOptics* birefringent_back = nullptr;
  const optics::BirefringentOptics* birefringent_front = nullptr;

  /// Indices on the two sides of one of its surfaces.
  optics::IndexPair around(bool back_surface) const {
    const double inside = back_surface ? back : front;
    return {inside, dry ? gap : (back_surface ? front : back),
            back_surface ? birefringent_back : birefringent_front,
            dry ? nullptr : (back_surface ? birefringent_front : birefringent_back)};
  }
};

/// The birefringent media on the two sides of an interface; null: of one index. Light enters an opaque region
/// as if the medium of incidence continued there.
struct BirefringentSides {
  const optics::BirefringentOptics* back = nullptr;
  const optics::BirefringentOptics* front = nullptr;
};
[[gnu::noinline, gnu::cold]] BirefringentSides find_birefringent_sides(const scene::Scene& scene,
                                                                       const scene::Interface& interface,
                                                                       double wavelength_nm);
inline BirefringentSides birefringent_sides(const scene::Scene& scene, const scene::Interface& interface,
                                            double wavelength_nm) {
  if (scene.optics.birefringent.empty()) [[likely]]
    return {};
  return find_birefringent_sides(scene, interface, wavelength_nm);
}

/// Conditions of incidence of a photon at an interface.
struct InterfaceApproach {
  const scene::Scene& scene;
  const scene::Interface& interface;
  bool from_back = false;  ///< the region of incidence is the back region
  core::Vec3 normal;       ///< of unit length, out of the back region
  InterfaceIndex index;    ///< at the photon's wavelength
};

/// Interactions with the interface's surfaces, reflections between the two included, until the photon is in
/// one of the regions or absorbed.
InterfaceOutcome interact_at_interface(const InterfaceApproach& at, source::Photon& photon, core::Rng& rng,
                                       source::PhotonRecords* records);

/// The event at the end of a propagation, which completes the step.
Step end_of_step(const scene::Scene& scene, const Propagation& propagation, source::Photon& photon,
                 core::Rng& rng, source::PhotonRecords* records);

/// Rayleigh scattering with the dipole pattern about the polarisation; for unpolarised light with 3/4
/// (1 + cos^2) (Born & Wolf, section 14.5.2).
void scatter_rayleigh(optics::Ray& ray, core::Rng& rng);

/// Scattering in a medium with particles; false where it is the medium's own. Out of line, as
/// shift_in_bulk.
[[gnu::noinline, gnu::cold]] bool scatter_at_particles(const scene::Scene& scene, core::MediumId id,
                                                       source::Photon& photon, core::Rng& rng);

/// Absorption in a medium with a wavelength shifter: true when the photon is re-emitted. Out of line, since
/// few scenes have one: inlined, it made every other step 3 % slower.
[[gnu::noinline, gnu::cold]] bool shift_in_bulk(const scene::Scene& scene, core::MediumId id,
                                                source::Photon& photon, core::Rng& rng,
                                                source::PhotonRecords* records);

}  // namespace scintray::transport
