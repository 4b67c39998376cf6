#pragma once
/// The photons of the pool (lane_pool.hpp) that are in the lanes of one vector, their random numbers, the
/// planes around them and the faces that they are at: taken from the pool and put back by rows of four
/// numbers.

#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/core/xoroshiro.hpp"
#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/transport/detail/lanes/lane_box.hpp"
#include "scintray/transport/detail/lanes/lane_planes.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"

namespace scintray::transport {

namespace {

using core::LaneFours;

/// @tparam kOneWavelength  LanePool::one_wavelength
template <typename Real, bool kOneWavelength>
class LanePhotons {
 protected:
  using Mask = typename Real::Mask;
  using Bits = typename Real::Bits;
  using Vector = core::Triple<Real>;
  static constexpr std::size_t kWidth = Real::kWidth;

  explicit LanePhotons(LanePool& pool) : pool_(pool) {}

  using Numbers = double[kWidth];
  using Counts = std::uint64_t[kWidth];
  static Real load(const Numbers& numbers) { return Real::load(numbers); }
  static Vector load(const Numbers (&numbers)[3]) {
    return {load(numbers[0]), load(numbers[1]), load(numbers[2])};
  }
  static Bits load(const Counts& counts) { return Bits::load(counts); }
  static void store(Numbers& to, const Real& value) { value.store(to); }
  static void store(Numbers (&to)[3], const Vector& value) {
    store(to[0], value.x), store(to[1], value.y), store(to[2], value.z);
  }
  static void store(Counts& to, const Bits& value) { value.store(to); }

  static Real one_if(const Mask& condition) { return where(condition, Real(1.0)); }

  /// One of two places, without a branch that would be predicted wrongly.
  /// @param first  1 or 0
  template <typename T>
  static T* one_of(std::uintptr_t first, T* yes, T* no) {
    const auto a = reinterpret_cast<std::uintptr_t>(yes), b = reinterpret_cast<std::uintptr_t>(no);
    return reinterpret_cast<T*>(b ^ ((a ^ b) & -first));
  }

  static int number_of_lanes(const Mask& mask) { return __builtin_popcount(lanes_of(mask)); }

  using Light = optics::LightRay<Real>;
  /// What almost every stage changes.
  struct Moving {
    Real state;  ///< lane_state; kEmpty in lanes without a photon
    Real side;
    Light light;
  };

  /// Takes photons of a state out of the pool into the lanes, as many as there are lanes: all but their
  /// places.
  void take(std::size_t state, Moving& moving) {
    std::uint64_t these = pool_.in_state[state];
    const int count = __builtin_popcountll(these);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      place_[lane] = these != 0 ? static_cast<std::uint32_t>(__builtin_ctzll(these)) : LanePool::kPhotons;
      these &= these - 1;
      bit_[lane] = std::uint64_t{1} << place_[lane];
      photon_[lane] = &pool_.photons[place_[lane]];
    }
    pool_.in_state[state] = these;
    const Mask taken = Mask::of(count < static_cast<int>(kWidth) ? (1U << count) - 1 : (1U << kWidth) - 1);
    moving.state = select(taken, Real(static_cast<double>(state)), Real(lane_state::kEmpty));
    const Row direction = row(offsetof(LanePhoton, direction)), optics = row(offsetof(LanePhoton, index)),
              of_surface = row(offsetof(LanePhoton, side));
    const Row polarisation = row(offsetof(LanePhoton, polarisation)),
              counts = row(offsetof(LanePhoton, interactions));
    moving.light = {{direction.of[0], direction.of[1], direction.of[2]},
                    {polarisation.of[0], polarisation.of[1], polarisation.of[2]}};
    moving.side = of_surface.of[0];
    store(time_ns_, direction.of[3]);
    store(depth_left_, polarisation.of[3]);
    store(interactions_, counts.of[0]);
    store(segments_, counts.of[1]);
    store(plane_, counts.of[2]);
    store(cos_before_, counts.of[3]);
    store(index_, optics.of[0]);
    store(group_index_, optics.of[1]);
    store(next_, of_surface.of[1]);
    store(stream_[0], bits_of(of_surface.of[2]));
    store(stream_[1], bits_of(of_surface.of[3]));
  }
  void take_places() {
    const Row position = row(offsetof(LanePhoton, position)), centre = row(offsetof(LanePhoton, centre));
    store(position_, {position.of[0], position.of[1], position.of[2]});
    store(path_mm_, position.of[3]);
    store(centre_, {centre.of[0], centre.of[1], centre.of[2]});
    store(attenuation_per_mm_, centre.of[3]);
  }
  /// What of the photons in the lanes may have changed beside Moving::light and time.
  struct Changed {
    bool places = false;   ///< take_places() was called
    bool surface = false;  ///< some photon was at a surface
    bool region = false;   ///< some photon is in another than before
  };
  /// Puts the photons back into the pool.
  void put_back(const Moving& moving, const Changed& changed) {
    const Vector direction = moving.light.direction, polarisation = moving.light.polarisation;
    put_row(offsetof(LanePhoton, direction), {{direction.x, direction.y, direction.z, load(time_ns_)}});
    put_row(offsetof(LanePhoton, polarisation),
            {{polarisation.x, polarisation.y, polarisation.z, load(depth_left_)}});
    if (changed.places) {
      const Vector position = load(position_);
      put_row(offsetof(LanePhoton, position), {{position.x, position.y, position.z, load(path_mm_)}});
      put_row(offsetof(LanePhoton, interactions),
              {{load(interactions_), load(segments_), load(plane_), load(cos_before_)}});
    }
    if (changed.region) {
      const Vector centre = load(centre_);
      put_row(offsetof(LanePhoton, centre), {{centre.x, centre.y, centre.z, load(attenuation_per_mm_)}});
      put_row(offsetof(LanePhoton, index), {{load(index_), load(group_index_), Real(0.0), Real(0.0)}});
    }
    if (changed.surface)
      put_row(offsetof(LanePhoton, side),
              {{moving.side, load(next_), number_of(load(stream_[0])), number_of(load(stream_[1]))}});
    alignas(64) Counts states;
    store(states, bits_of(moving.state + Real(0x1.0p52)));
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      pool_.in_state[static_cast<std::uint32_t>(states[lane])] |= bit_[lane];
  }

  using Stream = core::Xoroshiro<Bits>;
  /// The streams of random numbers, as far as numbers were used.
  Stream stream() const { return {load(stream_[0]), load(stream_[1])}; }
  /// Numbers of these photons up to there are used.
  void go_on_from(const Stream& behind, const Mask& those) {
    const Stream after = select<Real>(those, behind, stream());
    store(stream_[0], after.first), store(stream_[1], after.second);
  }

  /// The face that a photon is at.
  struct Now : Moving {
    Vector normal;  ///< of the face, out of the region
    Real kind, index_behind, least_sin2, counted, reflector;
    const double* face[kWidth];    ///< LaneFace
    const double* optics[kWidth];  ///< LaneFaceOptics; not set with one wavelength
  };

  void load_faces(Now& now) const {
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const LaneFace& face = photon_[lane]->region.faces[static_cast<std::uint32_t>(plane_[lane])];
      now.face[lane] = face.normal;
      if constexpr (!kOneWavelength) now.optics[lane] = photon_[lane]->optics[face.optics].of;
    }
    const LaneFours<Real> first = row_of(now.face, 0), second = optics_of(now, 0);
    now.normal = {first.of[0], first.of[1], first.of[2]};
    now.kind = first.of[3];
    now.index_behind = second.of[0];
    now.least_sin2 = second.of[1];
    now.counted = second.of[2];
    now.reflector = second.of[3];
  }
  /// Four numbers of LaneFaceOptics, the first, second or third.
  static LaneFours<Real> optics_of(const Now& now, int which) {
    return kOneWavelength ? row_of(now.face, which + 1) : row_of(now.optics, which);
  }
  /// Four numbers of a record of each lane.
  static LaneFours<Real> row_of(const double* const (&of)[kWidth], int which) {
    LaneFours<Real> fours;
    load_fours(core::LanePlaces<const double>{of, static_cast<std::size_t>(which) * 4 * sizeof(double)},
               fours);
    return fours;
  }
  static const LaneFace& face_of(const Now& now, std::size_t lane) {
    return *reinterpret_cast<const LaneFace*>(now.face[lane]);
  }

  /// The plane that each photon's ray leaves its region through.
  /// @param local  its origin in the region's frame
  LaneAhead<Real> nearest_plane(const Vector& local, const Vector& direction) const {
    LaneAhead<Real> nearest;
    const LaneRegion& one = photon_[0]->region;
    std::uintptr_t others = 0;
    for (std::size_t lane = 1; lane < kWidth; ++lane)
      others |= reinterpret_cast<std::uintptr_t>(photon_[lane]->region.planes) ^
                reinterpret_cast<std::uintptr_t>(one.planes);
    if (others == 0) {
      for (std::size_t i = 0; i < one.count; ++i) {
        const PlanePair& planes = one.planes[i];
        nearest.take({Real(planes.normal[0]), Real(planes.normal[1]), Real(planes.normal[2])},
                     Real(planes.first_mm), Real(planes.second_mm), local, direction,
                     2.0 * static_cast<double>(i));
      }
      return nearest;
    }
    std::size_t count = 0;
    for (const LanePhoton* photon : photon_)
      count = photon->region.count > count ? photon->region.count : count;
    for (std::size_t i = 0; i < count; ++i) {
      const double *first[kWidth], *second[kWidth];
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        const LaneRegion& region = photon_[lane]->region;  // the last planes again where there are fewer
        const PlanePair& planes = region.planes[i < region.count ? i : region.count - 1];
        first[lane] = planes.normal;
        second[lane] = &planes.second_mm;
      }
      LaneFours<Real> of_first, of_second;
      load_fours(first, of_first);
      load_fours(second, of_second);
      nearest.take({of_first.of[0], of_first.of[1], of_first.of[2]}, of_first.of[3], of_second.of[0], local,
                   direction, 2.0 * static_cast<double>(i));
    }
    return nearest;
  }

  /// The boxes around photons in regions that are boxes.
  LaneBox<Real> boxes() const {
    if (pool_.one_box) {
      const LaneBoxPlaces& box = *photon_[0]->region.box;
      return {{Real(box.first_mm[0]), Real(box.second_mm[0]), Real(box.first_mm[1]), Real(box.second_mm[1]),
               Real(box.first_mm[2]), Real(box.second_mm[2])}};
    }
    const double* places[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) places[lane] = photon_[lane]->region.box->first_mm;
    const LaneFours<Real> first = row_of(places, 0), second = row_of(places, 1);
    return {{first.of[0], second.of[0], first.of[1], second.of[1], first.of[2], second.of[2]}};
  }

  LanePool& pool_;
  // Of the photon in each lane, as of LanePhoton.
  LanePhoton* photon_[kWidth];
  alignas(64) Numbers position_[3], path_mm_, time_ns_, depth_left_, interactions_, segments_, plane_,
      cos_before_;
  alignas(64) Numbers centre_[3], attenuation_per_mm_, index_, group_index_, next_;

 private:
  using Row = LaneFours<Real>;
  /// Four numbers of each photon.
  /// @param offset  of the first one in LanePhoton
  Row row(std::size_t offset) const {
    Row numbers;
    load_fours(core::LanePlaces<LanePhoton>{photon_, offset}, numbers);
    return numbers;
  }
  void put_row(std::size_t offset, const Row& numbers) const {
    store_fours(numbers, core::LanePlaces<LanePhoton>{photon_, offset});
  }
  /// A bit for each photon of the pool that is in these lanes. Without a loop over them, whose length would
  /// be predicted wrongly.
  std::uint64_t places_of(const Mask& lanes) const {
    alignas(64) Counts each;
    store(each, bits_of(where(lanes, number_of(load(bit_)))));
    std::uint64_t places = 0;
    for (const std::uint64_t bit : each) places |= bit;
    return places;
  }

  std::uint32_t place_[kWidth];  ///< in the pool
  alignas(64) Counts bit_;       ///< for that
  alignas(64) Counts stream_[2];
};

}  // namespace
}  // namespace scintray::transport
