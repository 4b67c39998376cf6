#pragma once
/// The kernels of emission_kernels.hpp for one instruction set. Included by one file for each.

#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/core/philox_laws.hpp"
#include "scintray/core/sampling_laws.hpp"
#include "scintray/source/detail/lanes/emission_kernels.hpp"

namespace scintray::source {
namespace {

/// @tparam Real  numbers of kEmitted lanes
template <typename Real, core::LaneDraws kDraws>
struct EmissionKernelsOf {
  using Bits = core::BitsOf<Real>;
  using Vector = core::Triple<Real>;
  static_assert(Real::kWidth == kEmitted);

  [[gnu::flatten]] static void draw(StreamLanes& streams) {
    if constexpr (kDraws == core::LaneDraws::one_by_one) return draw_one_by_one(streams);
    const Bits first = Bits::load(streams.counter[0]);
    const auto block = [&](const Bits& number) {
      return core::PhiloxBlock<Bits>(
          {number, Bits::load(streams.counter[1]), Bits::load(streams.counter[2]),
           Bits::load(streams.counter[3])},
          core::PhiloxKeys<Bits>(Bits::load(streams.key[0]), Bits::load(streams.key[1])));
    };
    std::uint64_t* second[kEmitted];
    for (std::size_t lane = 0; lane < kEmitted; ++lane) second[lane] = streams.numbers[lane] + 4;
    core::store_fours(block(first).words, streams.numbers, streams.numbers);
    core::store_fours(block(first + Bits(1)).words, second, second);
  }

  /// As core::sample_isotropic and core::sample_polarisation, of which at most two points are drawn.
  [[gnu::flatten]] static void emit(LightLanes& light) {
    core::LaneFours<Real> fours;
    core::load_fours(light.numbers, fours);
    const Vector direction = core::isotropic<Real>(core::uniform_of<Real>(bits_of(fours.of[0])),
                                                   core::uniform_of<Real>(bits_of(fours.of[1])));
    const core::CirclePoint<Real> first(bits_of(fours.of[2])), second(bits_of(fours.of[3]));
    const Vector polarisation = select(first.accepted, core::across_at<Real>(direction, first),
                                       core::across_at<Real>(direction, second));
    store(direction, light.direction);
    store(polarisation, light.polarisation);
    const Real of_second = select(second.accepted, Real(2.0), Real(3.0));
    select(first.accepted, Real(1.0), of_second).store(light.tried);
  }

  /// As core::sample_exponential.
  [[gnu::flatten]] static void draw_depths(DepthLanes& depths) {
    (-core::laws::log<Real>(core::uniform_positive_of<Real>(Bits::load(depths.bits)))).store(depths.depth);
  }

  static EmissionKernels all() { return {draw, emit, draw_depths}; }

 private:
  static void draw_one_by_one(StreamLanes& streams) {
    core::PhiloxKeys<std::uint64_t> keys(streams.key[0][0], streams.key[1][0]);
    for (std::size_t lane = 0; lane < kEmitted; ++lane) {
      if (streams.key[0][lane] != keys.of[0][0] || streams.key[1][lane] != keys.of[0][1])
        keys = core::PhiloxKeys<std::uint64_t>(streams.key[0][lane], streams.key[1][lane]);
      for (std::uint64_t number = 0; number < 2; ++number) {
        const core::PhiloxBlock<std::uint64_t> block(
            {streams.counter[0][lane] + number, streams.counter[1][lane], streams.counter[2][lane],
             streams.counter[3][lane]},
            keys);
        for (std::size_t i = 0; i < 4; ++i) streams.numbers[lane][4 * number + i] = block.words[i];
      }
    }
  }
  static void store(const Vector& from, double (&to)[3][kEmitted]) {
    from.x.store(to[0]), from.y.store(to[1]), from.z.store(to[2]);
  }
};

}  // namespace
}  // namespace scintray::source
