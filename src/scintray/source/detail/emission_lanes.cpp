#include "scintray/source/detail/emission_lanes.hpp"

#include "scintray/core/sampling.hpp"

namespace scintray::source {

namespace {

EmissionKernels kernels_of(int lane_width) {
  switch (lane_width) {
#if defined(__x86_64__)
    case 4:
      return emission_kernels_4();
    case 8:
      return emission_kernels_8();
#endif
    default:
      return {};
  }
}

core::PlainVec3 vec(const double (&from)[3][kEmitted], std::size_t i) {
  return {from[0][i], from[1][i], from[2][i]};
}

}  // namespace

EmissionLanes::EmissionLanes(int lane_width) : kernels_(kernels_of(lane_width)) {}

void EmissionLanes::emit_isotropic(Photons photons, bool unpolarised) const {
  LightLanes light;  // NOLINT(cppcoreguidelines-pro-type-member-init): of all lanes below
  for (std::size_t i = 0; i < kEmitted; ++i) {
    const core::Rng::State& state = photons[std::min(i, photons.size() - 1)]->rng.state();
    light.state[0][i] = state.first;
    light.state[1][i] = state.second;
  }
  light.polarised = !unpolarised;
  kernels_.emit(light);
  for (std::size_t i = 0; i < photons.size(); ++i) {
    core::Rng& rng = photons[i]->rng;
    optics::Ray& ray = photons[i]->photon.ray;
    rng.go_on_from({light.state[0][i], light.state[1][i]});
    ray.direction = vec(light.direction, i);
    if (unpolarised)
      ray.polarisation = core::Vec3(core::Vec3::Zero());
    else if (light.has_polarisation[i] != 0.0)
      ray.polarisation = vec(light.polarisation, i);
    else
      ray.polarisation = core::sample_polarisation(ray.direction, rng);
  }
}

void EmissionLanes::draw_depths(Photons photons) const {
  DepthLanes depths;
  for (std::size_t i = 0; i < kEmitted; ++i) depths.bits[i] = i < photons.size() ? photons[i]->rng.bits() : 0;
  kernels_.draw_depths(depths);
  for (std::size_t i = 0; i < photons.size(); ++i) photons[i]->photon.optical_depth = depths.depth[i];
}

}  // namespace scintray::source
