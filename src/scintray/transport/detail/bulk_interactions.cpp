#include <algorithm>
#include <cmath>
#include <vector>

#include "scintray/core/sampling.hpp"
#include "scintray/optics/elliptical.hpp"
#include "scintray/source/photon_optics.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

/// A lobe of Henyey and Greenstein about the direction of the ray. The cosine is the inverse of the
/// cumulative distribution of their phase function (equation of docs/surfaces.md). A polarised ray keeps the
/// component of its polarisation perpendicular to the new direction.
void scatter_henyey_greenstein(optics::Ray& ray, double g, bool forward, core::Rng& rng) {
  const double u = rng.uniform();
  const double ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
  const double cosine = std::abs(g) < 1e-6 ? 2.0 * u - 1.0 : (1.0 + g * g - ratio * ratio) / (2.0 * g);
  const core::Vec3 axis = forward ? ray.direction.vec() : core::Vec3(-ray.direction.vec());
  const core::Vec3 direction =
      core::turned(axis, std::clamp(cosine, -1.0, 1.0), core::kTwoPi * rng.uniform());
  if (ray.keeps_phases && optics::project_field(ray, direction)) return;
  ray.direction = direction;
  if (ray.polarisation.isZero(0.0)) return;
  ray.ellipticity_rad = 0.0;
  const core::Vec3 across =
      ray.polarisation - ray.polarisation.dot(ray.direction.vec()) * ray.direction.vec();
  ray.polarisation =
      across.norm() > 1e-9 ? core::Vec3(across.normalized()) : core::sample_polarisation(ray.direction, rng);
}

[[gnu::noinline, gnu::cold]] void scatter_elliptical(optics::Ray& ray, core::Rng& rng) {
  for (;;) {
    const core::Vec3 direction = core::sample_isotropic(rng);
    if (rng.uniform() < optics::power_across(ray, direction) && optics::project_field(ray, direction)) return;
  }
}

/// Cosine to the field of polarised light of the direction of Rayleigh scattering, of density 3/4 (1 - c^2):
/// the middle one of three uniform numbers u has the density 6 u (1 - u), and c = 2 u - 1.
double cosine_across_field(core::Rng& rng) {
  const double a = rng.uniform(), b = rng.uniform(), c = rng.uniform();
  return 2.0 * std::max(std::min(a, b), std::min(std::max(a, b), c)) - 1.0;
}

/// Cosine of the angle of Rayleigh scattering of unpolarised light, of density 3/8 (1 + c^2).
double cosine_of_unpolarised(core::Rng& rng) {
  for (;;) {
    const double cosine = 2.0 * rng.uniform() - 1.0;
    if (rng.uniform() < 0.5 * (1.0 + cosine * cosine)) return cosine;
  }
}

}  // namespace

void scatter_rayleigh(optics::Ray& ray, core::Rng& rng) {
  if (ray.keeps_phases) [[unlikely]]
    return scatter_elliptical(ray, rng);
  const bool polarised = !ray.polarisation.isZero(0.0);
  const core::Triple<double> axis = core::triple((polarised ? ray.polarisation : ray.direction).vec());
  const double cosine = polarised ? cosine_across_field(rng) : cosine_of_unpolarised(rng);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const core::Triple<double> across = core::across_at<double>(axis, core::sample_circle(rng));
  ray.direction = core::vec(cosine * axis + sine * across);
  if (!polarised) return;
  // The field's component across the new direction; of unit length but for rounding, which a step of Newton's
  // method removes.
  const core::Triple<double> field = sine * axis - cosine * across;
  ray.polarisation = core::vec((1.5 - 0.5 * dot(field, field)) * field);
}

bool scatter_at_particles(const scene::Scene& scene, core::MediumId id, source::Photon& photon,
                          core::Rng& rng) {
  const optics::ParticleScattering& particles = *scene.media[id].medium().particles;
  if (rng.uniform() * photon.optics.scattering_per_mm >= source::scattering_by_particles(scene, photon))
    return false;
  const bool forward = rng.uniform() < particles.forward_share;
  scatter_henyey_greenstein(photon.ray, forward ? particles.forward_g : particles.backward_g, forward, rng);
  return true;
}

bool shift_in_bulk(const scene::Scene& scene, core::MediumId id, source::Photon& photon, core::Rng& rng,
                   source::PhotonRecords* records) {
  const double shifting_per_mm = scene.optics.shifting_at(id, photon.wavelength_nm);
  if (rng.uniform() * photon.optics.absorption_per_mm >= shifting_per_mm) return false;
  optics::ShiftCount not_recorded;
  optics::ShiftCount& count = records ? records->shifts_of(id) : not_recorded;
  const optics::WavelengthShifter& shifter = *scene.media[id].medium().shifter;
  std::vector<optics::ShiftedLight> more;
  const auto back = shifter.absorb(photon.wavelength_nm, rng, count, &more);
  if (!back) return false;
  const auto re_emit = [&](source::Photon& again, const optics::ShiftedLight& light) {
    again.wavelength_nm = light.wavelength_nm;
    again.time_ns += light.delay_ns;
    again.optics = scene.optics.at(id, again.wavelength_nm);
    optics::scatter_isotropic(again.ray, rng);
    source::emit_isotropic(scene, again, rng);
  };
  // The random numbers are drawn with and without records, so that a photon is replayed alike.
  for (const optics::ShiftedLight& light : more) {
    source::Photon additional = photon;
    re_emit(additional, light);
    additional.optical_depth = core::sample_exponential(rng);
    additional.conversion_draw = rng.uniform();
    additional.interactions = additional.scatterings = 0;
    if (records) records->add_photon(additional);
  }
  re_emit(photon, *back);
  return true;
}

}  // namespace scintray::transport
