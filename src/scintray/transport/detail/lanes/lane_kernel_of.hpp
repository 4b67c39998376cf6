#pragma once
/// The kernel of lane_kernel.hpp for one instruction set. Included by one file for each.

#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// The photons in the lanes. A lane whose photon has ended is filled with the next one at once; without a
/// next one it repeats another lane's photon, and its result is not stored.
///
/// @tparam Walls  LaneFlatWalls or LaneBodyWalls, of a number type
template <typename Walls>
class LanePropagation {
  using Real = typename Walls::Number;
  using Mask = typename Real::Mask;
  using Vector = core::Triple<Real>;
  using Numbers = LaneNumbers<Real>;
  using Numbers3 = LaneNumbers3<Real>;
  static constexpr std::size_t kWidth = Real::kWidth;

 public:
  LanePropagation(const typename Walls::Region& region, const LaneLimits& limits, LaneWork* photons,
                  std::size_t count)
      : walls_(region), limits_(limits), next_(photons), last_(photons + count) {}

  void run() {
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      code_.of[lane] = 0.0;
      photon_[lane] = nullptr;
      if (next_ != last_) fill(lane, next_++);
    }
    while (busy_ > 0) {
      repeat_in_idle_lanes();
      pass();
    }
  }

 private:
  void fill(std::size_t lane, LaneWork* photon) {
    set(lane, *photon);
    photon_[lane] = photon;
    ++busy_;
  }
  /// Lanes without a photon, whose last one has ended, repeat that of the first busy lane.
  void repeat_in_idle_lanes() {
    if (busy_ == kWidth) return;
    std::size_t busy = 0;
    while (!photon_[busy]) ++busy;
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      if (!photon_[lane] && code_.of[lane] != kGoesOn) copy(busy, lane);
  }
  void copy(std::size_t from, std::size_t to) {
    for (Numbers3* const triple : {&position_, &direction_, &polarisation_, &centre_}) triple->copy(from, to);
    for (Numbers* const numbers : {&path_, &time_, &depth_, &group_, &attenuation_, &interactions_})
      numbers->of[to] = numbers->of[from];
    least_sin2_[to] = least_sin2_[from];
    walls_.copy(from, to);
  }
  void set(std::size_t lane, const LaneWork& from) {
    position_.set(lane, from.position);
    direction_.set(lane, from.direction);
    polarisation_.set(lane, from.polarisation);
    centre_.set(lane, from.centre);
    path_.of[lane] = from.path_mm;
    time_.of[lane] = from.time_ns;
    depth_.of[lane] = from.depth_left;
    group_.of[lane] = from.group_index;
    attenuation_.of[lane] = from.attenuation_per_mm;
    interactions_.of[lane] = from.interactions;
    least_sin2_[lane] = from.least_sin2;
    walls_.set(lane, from);
    begun_[lane] = segments_;
  }

  /// Moves all lanes, until a photon ends in at least one of them.
  void pass() {
    const Real zero(0.0), one(1.0), two(2.0);
    const Vector centre = centre_.load();
    const Real group = group_.load(), attenuation = attenuation_.load();
    Vector position = position_.load(), direction = direction_.load(), polarisation = polarisation_.load();
    Real path = path_.load(), time = time_.load(), depth_left = depth_.load(),
         interactions = interactions_.load();
    Numbers faces, least;
    for (;;) {
      ++segments_;
      const Vector local = position - centre;
      const typename Walls::Ahead ahead = walls_.nearest(local, direction);
      const Real nearest = select(ahead.distance_mm < zero, zero, ahead.distance_mm);
      faces.store(ahead.plane);
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        least.of[lane] = least_sin2_[lane][static_cast<std::size_t>(faces.of[lane])];
      const Real least_sin2 = least.load();
      const Real depth = attenuation * nearest;
      const Mask stays = (depth > depth_left) | walls_.none(ahead) |
                         (least_sin2 > Real(0.5 * (kNoTotalReflection + kManyRegions)));
      Vector there = position + nearest * direction;
      const LaneIncidence<Real> at = walls_.arrive(faces, ahead, direction, centre, there);
      const Vector normal = at.normal;
      const Real cosine = at.cosine;
      const Mask total = totally_reflected(cosine, least_sin2);
      const Real there_path = path + nearest, there_depth = depth_left - depth,
                 there_time = time + time_along(nearest, group);
      // optics::reflect.
      const Vector reflected = direction - (two * cosine) * normal;
      const Vector reflected_polarisation = -core::mirrored(polarisation, normal);
      const Real counted = interactions + one;
      const Mask within = (counted < Real(limits_.interactions)) & (there_time <= Real(limits_.time_ns));
      if (all(total & within & !stays)) {
        position = there, direction = reflected, polarisation = reflected_polarisation;
        path = there_path, time = there_time, depth_left = there_depth, interactions = counted;
        walls_.leave(ahead);
        continue;
      }
      walls_.leave(ahead, stays);
      position_.store(select(stays, position, there));
      path_.store(select(stays, path, there_path));
      time_.store(select(stays, time, there_time));
      depth_.store(select(stays, depth_left, there_depth));
      const Mask turns = total & !stays;
      direction_.store(select(turns, reflected, direction));
      polarisation_.store(select(turns, reflected_polarisation, polarisation));
      interactions_.store(select(turns, counted, interactions));
      cosine_.store(cosine);
      const Real bulk = select(depth > depth_left, one, zero);
      const Real code = select(stays, bulk, select(total, select(within, Real(4.0), Real(3.0)), two));
      code_.store(code);
      break;
    }
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      if (const int code = static_cast<int>(code_.of[lane]); code != kGoesOn)
        end(lane, kEnds[code], static_cast<std::uint32_t>(faces.of[lane]));
  }

  static constexpr int kGoesOn = 4;
  static constexpr LaneEnd kEnds[] = {LaneEnd::unclear, LaneEnd::bulk, LaneEnd::boundary, LaneEnd::total};

  void end(std::size_t lane, LaneEnd how, std::uint32_t face) {
    LaneWork* const photon = photon_[lane];
    if (!photon) return;
    position_.get(lane, photon->position);
    direction_.get(lane, photon->direction);
    polarisation_.get(lane, photon->polarisation);
    photon->path_mm = path_.of[lane];
    photon->time_ns = time_.of[lane];
    photon->depth_left = depth_.of[lane];
    photon->interactions = interactions_.of[lane];
    photon->cosine = cosine_.of[lane];
    photon->face = face;
    walls_.get(lane, *photon);
    photon->segments = segments_ - begun_[lane] - (how == LaneEnd::unclear ? 1 : 0);
    photon->end = how;
    --busy_;
    photon_[lane] = nullptr;
    if (next_ != last_) fill(lane, next_++);
  }

  Walls walls_;
  const LaneLimits& limits_;
  LaneWork *next_, *last_;
  std::size_t busy_ = 0;
  std::uint32_t segments_ = 0;  ///< of each lane, since the beginning
  LaneWork* photon_[kWidth];
  std::uint32_t begun_[kWidth];
  const double* least_sin2_[kWidth];
  Numbers3 position_, direction_, polarisation_, centre_;
  Numbers path_, time_, depth_, group_, attenuation_, interactions_, cosine_, code_;
};

}  // namespace
}  // namespace scintray::transport
