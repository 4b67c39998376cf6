#pragma once
/// Optical properties of a photon's medium for its ray.

#include "scintray/source/light_source.hpp"

namespace scintray::source {

/// Sets Photon::optics in a birefringent medium, to those of the mode of the photon's ray, of which it first
/// takes one where it has none (optics::take_mode). In media of one index nothing happens.
void take_mode(const scene::Scene& scene, Photon& photon, core::Rng& rng);

/// Draws direction and polarisation of isotropic light in a birefringent medium (optics::emit_isotropic), and
/// sets Photon::optics. In media of one index nothing happens: their isotropic light is isotropic as drawn.
void emit_isotropic(const scene::Scene& scene, Photon& photon, core::Rng& rng);

/// The part of Photon::optics.scattering_per_mm that is due to particles in the medium: in a birefringent one
/// for the mode of the photon's ray, as dipoles of random orientation.
double scattering_by_particles(const scene::Scene& scene, const Photon& photon);

/// Scattering in a birefringent medium; false, with nothing done, in media of one index.
bool scatter(const scene::Scene& scene, Photon& photon, core::Rng& rng);

}  // namespace scintray::source
