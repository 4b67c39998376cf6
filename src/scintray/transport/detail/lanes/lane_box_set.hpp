#pragma once
/// Photons in the lanes of one vector in a region that is a box along the axes of its frame.
///
/// What total reflections in a box leave as it is, is computed once for each photon: the magnitudes of the
/// components of its direction, and so whether a face reflects totally; the polarisation's components change
/// their signs as those of the direction do, but for a sign of all three, which each reflection changes.

#include "scintray/transport/detail/lanes/lane_box.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// Has the bits of LaneSet<LaneFlatWalls>.
template <typename Real>
class LaneBoxSet {
  using Mask = typename Real::Mask;
  using Vector = core::Triple<Real>;
  using Numbers = LaneNumbers<Real>;
  using Numbers3 = LaneNumbers3<Real>;

 public:
  using Region = LanePlanes;
  static constexpr std::size_t kWidth = Real::kWidth;

  /// @param any  a photon, whose numbers serve lanes without one
  LaneBoxSet(const LanePlanes& box, const LaneLimits& limits, const LaneWork& any) : limits_(limits) {
    for (std::uint32_t i = 0; i < kFaces; ++i) offset_mm_[i] = box.plane(i)[3];
    for (std::size_t lane = 0; lane < kWidth; ++lane) set(lane, any);
  }

  /// A bit for each lane with a photon.
  unsigned busy() const { return busy_; }
  void fill(std::size_t lane, LaneWork& photon) {
    photon_[lane] = &photon;
    begun_[lane] = segments_;
    busy_ |= 1u << lane;
    set(lane, photon);
    const double passes = static_cast<double>(segments_) + (limits_.interactions - photon.interactions);
    first_limit_ = passes < first_limit_ ? passes : first_limit_;
  }

  /// Moves all lanes by a segment.
  /// @return a bit for each lane whose photon has ended
  unsigned pass() {
    const Segment to = segment();
    const unsigned goes_on = lanes_of((to.total < Real(0.0)) & (to.time <= Real(limits_.time_ns)) & !to.bulk);
    if ((busy_ & ~goes_on) != 0 || static_cast<double>(segments_ + 1) >= first_limit_) return end_pass();
    ++segments_;
    position_.store(to.there);
    direction_.store(to.ahead.signs().of(direction_.load()));
    path_.store(to.path), time_.store(to.time), depth_.store(to.depth_left);
    return 0;
  }
  /// Ends a photon that pass() has returned.
  void end(std::size_t lane) {
    constexpr LaneEnd kEnds[] = {LaneEnd::unclear, LaneEnd::bulk, LaneEnd::boundary, LaneEnd::total};
    const LaneEnd how = kEnds[static_cast<int>(code_.of[lane])];
    photon_[lane]->cosine = cosine_.of[lane];
    photon_[lane]->face = static_cast<std::uint32_t>(face_.of[lane]);
    const std::uint32_t passes = segments_ - begun_[lane];
    give_back(lane, how, passes - (how == LaneEnd::total ? 0 : 1));
    photon_[lane]->segments = passes - (how == LaneEnd::unclear ? 1 : 0);
  }
  void end_unfinished() {
    for (; busy_ != 0;) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(busy_));
      const std::uint32_t passes = segments_ - begun_[lane];
      give_back(lane, LaneEnd::unfinished, passes);
      photon_[lane]->segments = passes;
    }
  }

 private:
  static constexpr std::uint32_t kFaces = 6;
  /// To the next face.
  struct Segment {
    LaneBoxAhead<Real> ahead;
    Vector there;
    Real path, time, depth_left, total;
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
            ahead.of_face(of_face(total_, direction.x, 0), of_face(total_, direction.y, 1),
                          of_face(total_, direction.z, 2)),
            depth > depth_left};
  }
  /// As pass(), where some photon may end.
  [[gnu::noinline]] unsigned end_pass() {
    const Segment to = segment();
    const Real zero(0.0), one(1.0);
    ++segments_;
    const Vector position = position_.load(), direction = direction_.load();
    const Mask stays =
        to.bulk | (to.ahead.of_face(of_face(unclear_, direction.x, 0), of_face(unclear_, direction.y, 1),
                                    of_face(unclear_, direction.z, 2)) < zero);
    const Mask total = to.total < zero, turns = total & !stays;
    const Real along = to.ahead.along(direction);
    face_.store(to.ahead.face(along));
    cosine_.store(magnitude(along));
    position_.store(select(stays, position, to.there));
    direction_.store(select(turns, to.ahead.signs().of(direction), direction));
    path_.store(select(stays, path_.load(), to.path));
    time_.store(select(stays, time_.load(), to.time));
    depth_.store(select(stays, depth_.load(), to.depth_left));
    code_.store(select(stays, where(to.bulk, one), select(total, Real(3.0), Real(2.0))));
    const Real interactions = interactions_before_.load() + Real(static_cast<double>(segments_));
    const Mask within = (interactions < Real(limits_.interactions)) & (to.time <= Real(limits_.time_ns));
    return busy_ & ~lanes_of(turns & within);
  }
  /// Of the two faces across an axis that of a ray's side.
  static Real of_face(const Numbers (&of)[kFaces], const Real& towards, std::uint32_t axis) {
    return select_by_sign(towards, of[2 * axis].load(), of[2 * axis + 1].load());
  }

  void set(std::size_t lane, const LaneWork& photon) {
    position_.set(lane, photon.position);
    direction_.set(lane, photon.direction);
    centre_.set(lane, photon.centre);
    path_.of[lane] = photon.path_mm;
    time_.of[lane] = photon.time_ns;
    depth_.of[lane] = photon.depth_left;
    time_per_mm_.of[lane] = time_along(1.0, photon.group_index);
    attenuation_.of[lane] = photon.attenuation_per_mm;
    interactions_before_.of[lane] = photon.interactions - static_cast<double>(segments_);
    Numbers* const inverse[3] = {&inverse_.x, &inverse_.y, &inverse_.z};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const double along = core::magnitude(photon.direction[axis]);
      inverse[axis]->of[lane] = 1.0 / along;
      for (std::uint32_t face = 2 * axis; face < 2 * axis + 2; ++face) {
        total_[face].of[lane] = totally_reflected(along, photon.least_sin2[face]) ? -1.0 : 1.0;
        unclear_[face].of[lane] =
            photon.least_sin2[face] > 0.5 * (kNoTotalReflection + kManyRegions) ? -1.0 : 1.0;
      }
    }
  }
  /// @param reflections  in the lane
  void give_back(std::size_t lane, LaneEnd how, std::uint32_t reflections) {
    constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
    LaneWork& photon = *photon_[lane];
    const std::uint64_t all = (reflections & 1) != 0 ? kSign : 0;
    const double direction[3] = {direction_.x.of[lane], direction_.y.of[lane], direction_.z.of[lane]};
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t changed = core::bits_of(photon.direction[axis]) ^ core::bits_of(direction[axis]);
      photon.polarisation[axis] = core::number_of(core::bits_of(photon.polarisation[axis]) ^ changed ^ all);
      photon.direction[axis] = direction[axis];
    }
    position_.get(lane, photon.position);
    photon.path_mm = path_.of[lane];
    photon.time_ns = time_.of[lane];
    photon.depth_left = depth_.of[lane];
    photon.interactions += reflections;
    photon.end = how;
    busy_ &= ~(1u << lane);
  }

  const LaneLimits limits_;
  double offset_mm_[kFaces];
  unsigned busy_ = 0;
  std::uint32_t segments_ = 0;  ///< of each lane, since the beginning
  double first_limit_ =
      std::numeric_limits<double>::infinity();  ///< number of segments with which some photon has, or had,
                                                ///< its last interaction
  LaneWork* photon_[kWidth];
  std::uint32_t begun_[kWidth];
  Numbers3 position_, direction_, centre_, inverse_;
  Numbers path_, time_, depth_, time_per_mm_, attenuation_, interactions_before_;
  Numbers total_[kFaces],
      unclear_[kFaces];  ///< negative: the face reflects totally, leads to several regions
  // Of photons that end.
  Numbers cosine_, face_, code_;
};

}  // namespace
}  // namespace scintray::transport
