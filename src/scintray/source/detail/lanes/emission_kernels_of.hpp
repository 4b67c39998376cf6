#pragma once
/// The kernels of emission_kernels.hpp for one instruction set. Included by one file for each.

#include "scintray/core/lanes/lane_number.hpp"
#include "scintray/core/sampling_laws.hpp"
#include "scintray/core/xoroshiro.hpp"
#include "scintray/source/detail/lanes/emission_kernels.hpp"

namespace scintray::source {
namespace {

/// @tparam Real  numbers of kEmitted lanes
template <typename Real>
struct EmissionKernelsOf {
  using Bits = core::BitsOf<Real>;
  using Vector = core::Triple<Real>;
  static_assert(Real::kWidth == kEmitted);

  /// As core::sample_isotropic and core::sample_polarisation, of which at most two points are drawn.
  [[gnu::flatten]] static void emit(LightLanes& light) {
    core::Xoroshiro<Bits> random{Bits::load(light.state[0]), Bits::load(light.state[1])};
    const Real cosine = core::uniform_of<Real>(random.next());
    const Vector direction = core::isotropic<Real>(cosine, core::uniform_of<Real>(random.next()));
    store(direction, light.direction);
    if (light.polarised) {
      const core::CirclePoint<Real> first(random.next());
      const core::Xoroshiro<Bits> behind_first = random;
      const core::CirclePoint<Real> second(random.next());
      random = select<Real>(first.accepted, behind_first, random);
      const Vector polarisation = select(first.accepted, core::across_at<Real>(direction, first),
                                         core::across_at<Real>(direction, second));
      store(polarisation, light.polarisation);
      where(first.accepted | second.accepted, Real(1.0)).store(light.has_polarisation);
    }
    random.first.store(light.state[0]);
    random.second.store(light.state[1]);
  }

  /// As core::sample_exponential.
  [[gnu::flatten]] static void draw_depths(DepthLanes& depths) {
    (-core::laws::log<Real>(core::uniform_positive_of<Real>(Bits::load(depths.bits)))).store(depths.depth);
  }

  static EmissionKernels all() { return {emit, draw_depths}; }

 private:
  static void store(const Vector& from, double (&to)[3][kEmitted]) {
    from.x.store(to[0]), from.y.store(to[1]), from.z.store(to[2]);
  }
};

}  // namespace
}  // namespace scintray::source
