#pragma once
/// Photons in lanes in a region that is a box along the axes of its frame: total reflections are passed many
/// at once, and the segment after them, which nearly always ends in another event, as any.

#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/transport/detail/box_reflections.hpp"
#include "scintray/transport/detail/lanes/lane_box.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"

namespace scintray::transport {
namespace {

/// The photons in the lanes of one vector.
template <typename Real>
class LanesInBox {
  using Mask = typename Real::Mask;
  using Rows = core::LaneFours<Real>;
  using Vector = core::Triple<Real>;

 public:
  static constexpr std::size_t kWidth = Real::kWidth;

  LanesInBox(const LanePlanes& box, const LaneLimits& limits) : limits_(limits) {
    for (std::uint32_t i = 0; i < 6; ++i) box_.offset_mm[i] = Real(box.plane(i)[3]);
    for (int axis = 0; axis < 3; ++axis)
      per_length_[axis] = Real(1.0 / (box.plane(2 * axis)[3] + box.plane(2 * axis + 1)[3]));
  }

  /// Moves all photons to their next event but for a total reflection, or by one segment after which they
  /// have none.
  /// @return a bit for each lane whose photon goes on
  unsigned pass(LaneWork* const (&photons)[kWidth]) const {
    const auto row = [&](std::size_t offset) {
      Rows numbers;
      load_fours(core::LanePlaces<LaneWork>{photons, offset}, numbers);
      return numbers;
    };
    const double* least_sin2[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) least_sin2[lane] = photons[lane]->least_sin2;
    Rows of_xy, of_z;  // per face, in fours: the last two of the second are those across z
    load_fours(core::LanePlaces<const double>{least_sin2, 0}, of_xy);
    load_fours(core::LanePlaces<const double>{least_sin2, 2 * sizeof(double)}, of_z);
    const Rows p = row(offsetof(LaneWork, position)), d = row(offsetof(LaneWork, direction)),
               e = row(offsetof(LaneWork, polarisation)), numbers = row(offsetof(LaneWork, group_index)),
               c = row(offsetof(LaneWork, centre));
    const Real time_per_mm = time_along(Real(1.0), numbers.of[0]), attenuation = numbers.of[1];
    const Vector centre{c.of[0], c.of[1], c.of[2]}, at{p.of[0], p.of[1], p.of[2]};
    using Faces = typename BoxAxis<Real>::Faces;
    const Faces faces[3] = {{box_.offset_mm[0], box_.offset_mm[1], per_length_[0], of_xy.of[0], of_xy.of[1]},
                            {box_.offset_mm[2], box_.offset_mm[3], per_length_[1], of_xy.of[2], of_xy.of[3]},
                            {box_.offset_mm[4], box_.offset_mm[5], per_length_[2], of_z.of[2], of_z.of[3]}};
    const BoxReflections<Real> passed(faces, at - centre,
                                      {{d.of[0], d.of[1], d.of[2]}, {e.of[0], e.of[1], e.of[2]}},
                                      {e.of[3], attenuation, Real(limits_.time_ns) - d.of[3], time_per_mm,
                                       Real(limits_.interactions) - numbers.of[2]});
    const Vector position = passed.position(at, centre);
    const optics::LightRay<Real> light = passed.light();
    const Vector direction = light.direction, polarisation = light.polarisation;
    const Real path = p.of[3] + passed.path_mm, time = d.of[3] + passed.path_mm * time_per_mm,
               depth_left = e.of[3] - attenuation * passed.path_mm;

    const LaneBoxAhead<Real> ahead(box_, position - centre, direction, passed.per_speed());
    const Real distance = ahead.distance_mm, depth = attenuation * distance;
    const Real along = ahead.along(direction), cosine = magnitude(along);
    const Real sin2 = ahead.of_face(select_by_sign(direction.x, of_xy.of[0], of_xy.of[1]),
                                    select_by_sign(direction.y, of_xy.of[2], of_xy.of[3]),
                                    select_by_sign(direction.z, of_z.of[2], of_z.of[3]));
    const Mask bulk = depth > depth_left;
    const Mask stays = bulk | (sin2 > Real(0.5 * (kNoTotalReflection + kManyRegions)));
    const Mask total = totally_reflected(cosine, sin2);
    const auto turns = bits_of(where(total & !stays, Real(-0.0)));
    LaneSigns<Real> signs = ahead.signs();
    signs = {signs.x & turns, signs.y & turns, signs.z & turns};
    const LaneSigns<Real> across{signs.x ^ turns, signs.y ^ turns, signs.z ^ turns};
    const Real there_time = time + distance * time_per_mm;
    const Real interactions = numbers.of[2] + passed.count + where(total & !stays, Real(1.0));
    const Mask goes_on = total & (!stays) & (interactions < Real(limits_.interactions)) &
                         (there_time <= Real(limits_.time_ns));

    const auto put = [&](std::size_t offset, const Vector& three, const Real& fourth) {
      store_fours(Rows{{three.x, three.y, three.z, fourth}}, core::LanePlaces<LaneWork>{photons, offset});
    };
    put(offsetof(LaneWork, position), select(stays, position, position + distance * direction),
        select(stays, path, path + distance));
    put(offsetof(LaneWork, direction), signs.of(direction), select(stays, time, there_time));
    put(offsetof(LaneWork, polarisation), across.of(polarisation),
        select(stays, depth_left, depth_left - depth));
    put(offsetof(LaneWork, group_index), {numbers.of[0], attenuation, interactions}, cosine);
    LaneNumbers<Real> face, segments, code;
    face.store(ahead.face(along));
    segments.store(passed.count + select(stays & !bulk, Real(0.0), Real(1.0)));
    code.store(select(stays, where(bulk, Real(1.0)), select(total, Real(3.0), Real(2.0))));
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      constexpr LaneEnd kEnds[] = {LaneEnd::unclear, LaneEnd::bulk, LaneEnd::boundary, LaneEnd::total};
      LaneWork& photon = *photons[lane];
      photon.face = static_cast<std::uint32_t>(face.of[lane]);
      photon.segments += static_cast<std::uint32_t>(segments.of[lane]);
      photon.end = kEnds[static_cast<int>(code.of[lane])];
    }
    return lanes_of(goes_on);
  }

 private:
  LaneLimits limits_;
  LaneBox<Real> box_;
  Real per_length_[3];
};

/// Inlined, so that a profile has the time under the name of the kernel, which is known outside its file.
template <typename Real>
[[gnu::flatten, gnu::always_inline]] inline void propagate_in_box(const LanePlanes& box,
                                                                  const LaneLimits& limits,
                                                                  LaneWork* const* photons,
                                                                  std::size_t count) {
  constexpr std::size_t kWidth = Real::kWidth;
  const LanesInBox<Real> lanes(box, limits);
  LaneWork none = **photons;
  for (std::size_t first = 0; first < count; first += kWidth) {
    LaneWork* in_lanes[kWidth];
    unsigned going = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      in_lanes[lane] = first + lane < count ? photons[first + lane] : &none;
      in_lanes[lane]->segments = 0;
      going |= (first + lane < count ? 1u : 0u) << lane;
    }
    for (;;) {
      going &= lanes.pass(in_lanes);
      if (going == 0) [[likely]]
        break;
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        if ((going >> lane & 1) == 0) in_lanes[lane] = &none;
    }
  }
}

}  // namespace
}  // namespace scintray::transport
