#include "scintray/source/photon_optics.hpp"

namespace scintray::source {

namespace {

const optics::BirefringentOptics* birefringent_medium(const scene::Scene& scene, const Photon& photon) {
  return scene.optics.birefringent_at(scene.regions[photon.region].medium, photon.wavelength_nm);
}

/// Coefficient of scattering by particles of the medium.
double particles_per_mm(const scene::Scene& scene, const Photon& photon) {
  const core::MediumId id = scene.regions[photon.region].medium;
  if (!scene.optics.media[id].particles) return 0.0;
  return scene.media[id].medium().particles->per_mm(photon.wavelength_nm);
}

void set_mode_optics(const scene::Scene& scene, const optics::BirefringentOptics& medium, Photon& photon) {
  const core::MediumId id = scene.regions[photon.region].medium;
  const optics::ModeOptics mode = optics::mode_of(medium, photon.ray);
  photon.optics.index = mode.index;
  photon.optics.group_index = mode.group_index;
  // The scattering coefficient of the medium is that of its mean index.
  const optics::MediumOptics mean = scene.optics.at(id, photon.wavelength_nm);
  const double by_particles = particles_per_mm(scene, photon);
  const bool rayleigh = scene.optics.media[id].scattering == optics::ScatteringKind::rayleigh;
  photon.optics.scattering_per_mm = mean.index * ((mean.scattering_per_mm - by_particles) *
                                                      (rayleigh ? mode.rayleigh_rate : mode.dipole_rate) +
                                                  by_particles * mode.dipole_rate);
  photon.optics.absorption_per_mm =
      mode.absorption_per_mm +
      (scene.optics.media[id].shifts ? scene.optics.shifting_at(id, photon.wavelength_nm) : 0.0);
}

}  // namespace

void take_mode(const scene::Scene& scene, Photon& photon, core::Rng& rng) {
  const optics::BirefringentOptics* const medium = birefringent_medium(scene, photon);
  if (!medium) return;
  optics::take_mode(*medium, photon.ray, rng);
  set_mode_optics(scene, *medium, photon);
}

void emit_isotropic(const scene::Scene& scene, Photon& photon, core::Rng& rng) {
  const optics::BirefringentOptics* const medium = birefringent_medium(scene, photon);
  if (!medium) return;
  optics::emit_isotropic(*medium, photon.ray, rng);
  set_mode_optics(scene, *medium, photon);
}

double scattering_by_particles(const scene::Scene& scene, const Photon& photon) {
  const double per_mm = particles_per_mm(scene, photon);
  const optics::BirefringentOptics* const medium = birefringent_medium(scene, photon);
  if (!medium) return per_mm;
  const double mean_index = scene.optics.at(scene.regions[photon.region].medium, photon.wavelength_nm).index;
  return per_mm * mean_index * optics::mode_of(*medium, photon.ray).dipole_rate;
}

bool scatter(const scene::Scene& scene, Photon& photon, core::Rng& rng) {
  const optics::BirefringentOptics* const medium = birefringent_medium(scene, photon);
  if (!medium) return false;
  if (scene.optics.media[scene.regions[photon.region].medium].scattering == optics::ScatteringKind::rayleigh)
    optics::scatter_rayleigh(*medium, photon.ray, rng);
  else
    optics::emit_isotropic(*medium, photon.ray, rng);
  set_mode_optics(scene, *medium, photon);
  return true;
}

}  // namespace scintray::source
