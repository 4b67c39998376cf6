#pragma once
/// Fresnel's equations for photons in lanes.

#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/core/xoroshiro.hpp"
#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"

namespace scintray::transport {
namespace {

template <typename Real>
struct RefractedIn {
  optics::LightRay<Real> light;
  core::MaskOf<Real> transmitted;
  core::MaskOf<Real> drawn;  ///< the random number was used
};
/// As optics::interact_at_facet.
template <typename Real>
RefractedIn<Real> refract(const optics::LightRay<Real>& light, const core::Triple<Real>& m, const Real& n1,
                          const Real& n2, const core::BitsOf<Real>& random) {
  using Mask = core::MaskOf<Real>;
  using Vector = core::Triple<Real>;
  const Real cos_i = cos_incidence(light, m);
  const optics::RefractionOf<Real> refraction(cos_i, n1, n2);
  const Mask total = refraction.total(), unpolarised = is_zero(light.polarisation);
  optics::FacetLight<Real> facet(light, m, cos_i, refraction, n1, n2);
  const Mask straight = (!unpolarised) & (refraction.sin2_i < Real(optics::kNormalIncidence));
  const Real uniform = core::uniform_of<Real>(random);
  Mask transmitted = facet.transmits_polarised(uniform);
  const Mask others = unpolarised | straight;
  if (any(others))
    transmitted = (transmitted & !others) | (unpolarised & facet.transmits_unpolarised(uniform)) |
                  (straight & facet.transmits_straight(uniform));
  transmitted = transmitted & !total;
  Vector direction = select(transmitted, facet.refracted(), facet.mirrored());
  Vector polarisation = facet.polarised(transmitted, direction);
  if (any(others | total)) {
    const Mask goes_on = straight & transmitted;
    direction = select(goes_on, light.direction, direction);
    polarisation = select(unpolarised | goes_on, light.polarisation, polarisation);
    polarisation =
        select(total | (straight & !transmitted), optics::reflected(light, m).polarisation, polarisation);
  }
  return {{direction, polarisation}, transmitted, !total};
}

/// The kernel of lane_kernel.hpp. Inlined, so that a profile has the time under its name.
template <typename Real>
[[gnu::flatten, gnu::always_inline]] inline void refract_at_faces(const LaneNormal* normals,
                                                                  LaneWork* const* photons,
                                                                  std::size_t count) {
  using Rows = core::LaneFours<Real>;
  constexpr std::size_t kWidth = Real::kWidth;
  LaneWork none = **photons;
  for (std::size_t first = 0; first < count; first += kWidth) {
    LaneWork* at[kWidth];
    const double* normal_at[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      at[lane] = first + lane < count ? photons[first + lane] : &none;
      normal_at[lane] = normals[at[lane]->face].of;
    }
    const auto row = [&](std::size_t offset) {
      Rows numbers;
      load_fours(core::LanePlaces<LaneWork>{at, offset}, numbers);
      return numbers;
    };
    Rows normal;
    load_fours(core::LanePlaces<const double>{normal_at, 0}, normal);
    const Rows direction = row(offsetof(LaneWork, direction)),
               polarisation = row(offsetof(LaneWork, polarisation)), optics = row(offsetof(LaneWork, index));
    core::Xoroshiro<core::BitsOf<Real>> stream{bits_of(optics.of[2]), bits_of(optics.of[3])};
    const auto before = stream;
    const RefractedIn<Real> after =
        refract<Real>({{direction.of[0], direction.of[1], direction.of[2]},
                       {polarisation.of[0], polarisation.of[1], polarisation.of[2]}},
                      -core::Triple<Real>{normal.of[0], normal.of[1], normal.of[2]}, optics.of[0],
                      optics.of[1], stream.next());
    stream = core::select<Real>(after.drawn, stream, before);
    const auto put = [&](std::size_t offset, const core::Triple<Real>& three, const Real& fourth) {
      store_fours(Rows{{three.x, three.y, three.z, fourth}}, core::LanePlaces<LaneWork>{at, offset});
    };
    put(offsetof(LaneWork, direction), after.light.direction, direction.of[3]);
    put(offsetof(LaneWork, polarisation), after.light.polarisation, polarisation.of[3]);
    put(offsetof(LaneWork, index), {optics.of[0], optics.of[1], number_of(stream.first)},
        number_of(stream.second));
    const unsigned transmitted = lanes_of(after.transmitted);
    for (std::size_t lane = 0; lane < kWidth; ++lane) at[lane]->transmitted = transmitted >> lane & 1;
  }
}

}  // namespace
}  // namespace scintray::transport
