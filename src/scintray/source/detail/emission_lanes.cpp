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

void EmissionLanes::begin(Photons photons) const {
  StreamLanes streams;  // NOLINT(cppcoreguidelines-pro-type-member-init): of all lanes below
  std::uint64_t unused[core::Rng::kDrawn];
  for (std::size_t i = 0; i < kEmitted; ++i) {
    if (i >= photons.size()) {
      for (auto& of_lanes : streams.counter) of_lanes[i] = 0;
      for (auto& of_lanes : streams.key) of_lanes[i] = 0;
      streams.numbers[i] = unused;
      continue;
    }
    photons[i]->photon = {};
    core::Rng& rng = photons[i]->rng;
    for (std::size_t k = 0; k < 4; ++k) streams.counter[k][i] = rng.counter()[k];
    for (std::size_t k = 0; k < 2; ++k) streams.key[k][i] = rng.key()[k];
    streams.numbers[i] = rng.take_two_blocks();
  }
  kernels_.draw(streams);
}

void EmissionLanes::emit_isotropic(Photons photons, bool unpolarised) const {
  static constexpr std::uint64_t kNone[4] = {};
  constexpr std::size_t kNeeded = 4;
  LightLanes light;
  for (std::size_t i = 0; i < kEmitted; ++i) {
    const bool known = i < photons.size() && photons[i]->rng.ahead().size() >= kNeeded;
    light.numbers[i] = reinterpret_cast<const double*>(known ? photons[i]->rng.ahead().data() : kNone);
  }
  kernels_.emit(light);
  for (std::size_t i = 0; i < photons.size(); ++i) {
    core::Rng& rng = photons[i]->rng;
    optics::Ray& ray = photons[i]->photon.ray;
    const bool known = rng.ahead().size() >= kNeeded;
    if (known) {
      ray.direction = vec(light.direction, i);
      rng.skip(2);
    } else {
      ray.direction = core::sample_isotropic(rng);
    }
    const auto tried = static_cast<int>(light.tried[i]);
    if (unpolarised) {
      ray.polarisation = core::Vec3(core::Vec3::Zero());
    } else if (known && tried <= 2) {
      ray.polarisation = vec(light.polarisation, i);
      rng.skip(tried);
    } else {
      ray.polarisation = core::sample_polarisation(ray.direction, rng);
    }
  }
}

void EmissionLanes::draw_depths(Photons photons) const {
  DepthLanes depths;
  for (std::size_t i = 0; i < kEmitted; ++i) depths.bits[i] = i < photons.size() ? photons[i]->rng.bits() : 0;
  kernels_.draw_depths(depths);
  for (std::size_t i = 0; i < photons.size(); ++i) photons[i]->photon.optical_depth = depths.depth[i];
}

}  // namespace scintray::source
