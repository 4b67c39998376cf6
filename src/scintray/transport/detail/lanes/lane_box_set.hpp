#pragma once
/// Photons in the lanes of one vector in a region that is a box along the axes of its frame.
///
/// What total reflections in a box leave as it is, is computed once for each photon: the magnitudes of the
/// components of its direction, and so whether a face reflects totally; the polarisation's components change
/// their signs as those of the direction do, but for a sign of all three, which each reflection changes.

#include "scintray/transport/detail/lanes/lane_box.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// Has the bits of LaneSet<LaneFlatWalls>.
template <typename Real>
class LaneBoxSet : public LaneSlots<Real> {
  using Slots = LaneSlots<Real>;
  using typename Slots::Mask;
  using typename Slots::Numbers;
  using typename Slots::Vector;

 public:
  using Region = LanePlanes;

  /// @param any  a photon, whose numbers serve lanes without one
  LaneBoxSet(const LanePlanes& box, const LaneLimits& limits, const LaneWork& any) : Slots(limits) {
    for (std::uint32_t i = 0; i < kFaces; ++i) offset_mm_[i] = box.plane(i)[3];
    for (std::size_t lane = 0; lane < Slots::kWidth; ++lane) set(lane, any);
  }

  void fill(std::size_t lane, LaneWork& photon) {
    set(lane, photon);
    Slots::take(lane, photon);
  }
  /// Moves all lanes by a segment.
  /// @return a bit for each lane whose photon has ended
  unsigned pass() {
    const Segment to = segment();
    const unsigned goes_on =
        lanes_of((to.total < Real(0.0)) & (to.time <= Real(Slots::limits_.time_ns)) & !to.bulk);
    if ((Slots::busy() & ~goes_on) != 0 || Slots::may_be_last()) return last_pass();
    Slots::count_pass();
    position_.store(to.there);
    direction_.store(to.ahead.signs().of(direction_.load()));
    path_.store(to.path), time_.store(to.time), depth_.store(to.depth_left);
    return 0;
  }
  /// Takes a photon out of its lane.
  void give_back(std::size_t lane, LaneEnd how) {
    constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
    const auto [photon, reflections] = Slots::release(lane, how);
    const std::uint64_t all = (reflections & 1) != 0 ? kSign : 0;
    double direction[3];
    direction_.get(lane, direction);
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t changed = core::bits_of(photon.direction[axis]) ^ core::bits_of(direction[axis]);
      photon.polarisation[axis] = core::number_of(core::bits_of(photon.polarisation[axis]) ^ changed ^ all);
      photon.direction[axis] = direction[axis];
    }
  }

 private:
  using Slots::attenuation_;
  using Slots::centre_;
  using Slots::depth_;
  using Slots::direction_;
  using Slots::path_;
  using Slots::position_;
  using Slots::time_;
  using Slots::time_per_mm_;
  static constexpr std::uint32_t kFaces = 6;
  /// To the next face.
  struct Segment {
    LaneBoxAhead<Real> ahead;
    Vector there;
    Real path, time, depth_left;
    Real total;  ///< negative: the face reflects totally
    Mask bulk;
  };

  [[gnu::always_inline]] Segment segment() const {
    LaneBox<Real> box;
    for (std::uint32_t i = 0; i < kFaces; ++i) box.offset_mm[i] = Real(offset_mm_[i]);
    const Vector position = position_.load(), direction = direction_.load();
    const LaneBoxAhead<Real> ahead(box, position - centre_.load(), direction, inverse_.load());
    const Real distance = ahead.distance_mm, depth = attenuation_.load() * distance,
               depth_left = depth_.load();
    return {ahead,
            position + distance * direction,
            path_.load() + distance,
            time_.load() + distance * time_per_mm_.load(),
            depth_left - depth,
            at_face(total_, ahead, direction),
            depth > depth_left};
  }
  /// As pass(), where some photon may end: the same numbers once more, so that passes in which none ends keep
  /// nothing for it.
  [[gnu::noinline]] unsigned last_pass() {
    const Segment to = segment();
    const Vector position = position_.load(), direction = direction_.load();
    const Mask stays = to.bulk | (at_face(unclear_, to.ahead, direction) < Real(0.0));
    const Mask total = to.total < Real(0.0), turns = total & !stays;
    Slots::count_pass();
    position_.store(select(stays, position, to.there));
    direction_.store(select(turns, to.ahead.signs().of(direction), direction));
    path_.store(select(stays, path_.load(), to.path));
    time_.store(select(stays, time_.load(), to.time));
    depth_.store(select(stays, depth_.load(), to.depth_left));
    const Real along = to.ahead.along(direction);
    return Slots::keep({stays, to.bulk, total, turns, to.ahead.face(along), magnitude(along)}, to.time);
  }
  /// Numbers of the face that a ray leaves through.
  static Real at_face(const Numbers (&of)[kFaces], const LaneBoxAhead<Real>& ahead, const Vector& direction) {
    const auto across = [&of](std::uint32_t axis, const Real& towards) {
      return select_by_sign(towards, of[2 * axis].load(), of[2 * axis + 1].load());
    };
    return ahead.of_face(across(0, direction.x), across(1, direction.y), across(2, direction.z));
  }

  void set(std::size_t lane, const LaneWork& photon) {
    Slots::set(lane, photon);
    Numbers* const inverse[3] = {&inverse_.x, &inverse_.y, &inverse_.z};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const double along = core::magnitude(photon.direction[axis]);
      inverse[axis]->of[lane] = 1.0 / along;
      for (std::uint32_t face = 2 * axis; face < 2 * axis + 2; ++face) {
        const double least_sin2 = photon.least_sin2[face];
        total_[face].of[lane] = totally_reflected(along, least_sin2) ? -1.0 : 1.0;
        unclear_[face].of[lane] = least_sin2 > 0.5 * (kNoTotalReflection + kManyRegions) ? -1.0 : 1.0;
      }
    }
  }

  double offset_mm_[kFaces];
  typename Slots::Numbers3 inverse_;  ///< of the magnitudes of the direction's components
  Numbers total_[kFaces],
      unclear_[kFaces];  ///< negative: the face reflects totally, leads to several regions
};

/// Inlined, so that a profile has the time under the name of the kernel, which is known outside its file. Two
/// vectors take turns: each waits for its divisions and selections for half of a pass.
template <typename Real>
[[gnu::always_inline]] inline void propagate_in_box(const LanePlanes& box, const LaneLimits& limits,
                                                    LaneWork* const* photons, std::size_t count) {
  LanePropagation<LaneBoxSet<Real>, 2>::run(box, limits, photons, count);
}

}  // namespace
}  // namespace scintray::transport
