#pragma once
/// The kernel of lane_kernel.hpp for one instruction set. Included by one file for each.

#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// The photons in the lanes. A lane whose photon has ended is filled with the next one at once. Without a
/// next one the lane has numbers of no photon, and none of its results is stored.
///
/// Photons enter their lanes by masks, and their numbers stay in registers in between: the load of a vector
/// waits until stores of its parts have left the store buffer.
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
  /// Photons in fewer lanes than this are handed back unfinished when there is no other to fill lanes with.
  static constexpr int kFew = static_cast<int>(kWidth / 2);

 public:
  LanePropagation(const typename Walls::Region& region, const LaneLimits& limits, LaneWork* photons,
                  std::size_t count)
      : walls_(region, *photons),
        limits_(limits),
        next_(photons),
        last_(photons + count),
        hands_back_(count > kWidth) {}

  [[gnu::flatten]] void run() {
    Now now{};
    for (std::size_t lane = 0; lane < kWidth && next_ != last_; ++lane) fill(lane, now);
    while (busy_ != 0) {
      const unsigned ended = busy_ & ~pass(now);
      if (ended == 0) continue;
      for (unsigned lanes = ended; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(lanes));
        end(lane, kEnds[static_cast<int>(code_.of[lane])]);
        if (next_ != last_) fill(lane, now);
      }
      if (hands_back_ && next_ == last_ && __builtin_popcount(busy_) < kFew) {
        store(now);
        for (; busy_ != 0;) end(static_cast<std::size_t>(__builtin_ctz(busy_)), LaneEnd::unfinished);
      }
    }
  }

 private:
  /// The photons.
  struct Now {
    Vector position, direction, polarisation, centre;
    Real path, time, depth_left, group, attenuation, interactions;
  };

  void fill(std::size_t lane, Now& now) {
    const LaneWork& photon = *next_;
    photon_[lane] = next_++;
    begun_[lane] = segments_;
    busy_ |= 1u << lane;
    const Mask here = Mask::of(1u << lane);
    const auto put = [&here](double value, Real& to) { to = select(here, Real(value), to); };
    const auto put3 = [&put](const double* from, Vector& to) {
      put(from[0], to.x), put(from[1], to.y), put(from[2], to.z);
    };
    put3(photon.position, now.position);
    put3(photon.direction, now.direction);
    put3(photon.polarisation, now.polarisation);
    put3(photon.centre, now.centre);
    put(photon.path_mm, now.path);
    put(photon.time_ns, now.time);
    put(photon.depth_left, now.depth_left);
    put(photon.group_index, now.group);
    put(photon.attenuation_per_mm, now.attenuation);
    put(photon.interactions, now.interactions);
    walls_.set(lane, here, photon);
  }

  /// Moves all lanes by a segment.
  /// @return a bit for each lane whose photon goes on; where one does not, numbers to end it with are stored
  unsigned pass(Now& now) {
    const Real zero(0.0), one(1.0), two(2.0);
    ++segments_;
    const typename Walls::Ahead ahead = walls_.nearest(now.position - now.centre, now.direction);
    const Real nearest = select(ahead.distance_mm < zero, zero, ahead.distance_mm);
    const Real depth = now.attenuation * nearest;
    const Mask bulk = depth > now.depth_left;
    Vector there = now.position + nearest * now.direction;
    const LaneArrival<Real> at = walls_.arrive(ahead, now.direction, now.centre, there);
    const Mask stays =
        bulk | walls_.none(ahead) | (at.least_sin2 > Real(0.5 * (kNoTotalReflection + kManyRegions)));
    const Mask total = totally_reflected(at.cosine, at.least_sin2);
    const Real there_path = now.path + nearest, there_depth = now.depth_left - depth,
               there_time = now.time + time_along(nearest, now.group);
    // optics::reflect.
    const Vector reflected = now.direction - (two * at.cosine) * at.normal;
    const Vector reflected_polarisation = -core::mirrored(now.polarisation, at.normal);
    const Real counted = now.interactions + one;
    const Mask within = (counted < Real(limits_.interactions)) & (there_time <= Real(limits_.time_ns));
    const unsigned going = lanes_of(total & within & !stays);
    if ((busy_ & ~going) == 0) {
      now.position = there, now.direction = reflected, now.polarisation = reflected_polarisation;
      now.path = there_path, now.time = there_time, now.depth_left = there_depth, now.interactions = counted;
      walls_.leave(ahead);
      return going;
    }
    walls_.leave(ahead, stays);
    const Mask turns = total & !stays;
    now.position = select(stays, now.position, there);
    now.path = select(stays, now.path, there_path);
    now.time = select(stays, now.time, there_time);
    now.depth_left = select(stays, now.depth_left, there_depth);
    now.direction = select(turns, reflected, now.direction);
    now.polarisation = select(turns, reflected_polarisation, now.polarisation);
    now.interactions = select(turns, counted, now.interactions);
    store(now);
    cosine_.store(at.cosine);
    face_.store(ahead.plane);
    code_.store(select(stays, select(bulk, one, zero), select(total, Real(3.0), two)));
    return going;
  }
  static constexpr LaneEnd kEnds[] = {LaneEnd::unclear, LaneEnd::bulk, LaneEnd::boundary, LaneEnd::total};

  /// Stores what end() needs.
  void store(const Now& now) {
    position_.store(now.position);
    direction_.store(now.direction);
    polarisation_.store(now.polarisation);
    path_.store(now.path);
    time_.store(now.time);
    depth_.store(now.depth_left);
    interactions_.store(now.interactions);
    walls_.store();
  }
  void end(std::size_t lane, LaneEnd how) {
    LaneWork* const photon = photon_[lane];
    position_.get(lane, photon->position);
    direction_.get(lane, photon->direction);
    polarisation_.get(lane, photon->polarisation);
    photon->path_mm = path_.of[lane];
    photon->time_ns = time_.of[lane];
    photon->depth_left = depth_.of[lane];
    photon->interactions = interactions_.of[lane];
    photon->cosine = cosine_.of[lane];
    photon->face = static_cast<std::uint32_t>(face_.of[lane]);
    walls_.get(lane, *photon);
    photon->segments = segments_ - begun_[lane] - (how == LaneEnd::unclear ? 1 : 0);
    photon->end = how;
    busy_ &= ~(1u << lane);
  }

  Walls walls_;
  const LaneLimits& limits_;
  LaneWork *next_, *last_;
  bool hands_back_;
  unsigned busy_ = 0;           ///< a bit for each lane with a photon
  std::uint32_t segments_ = 0;  ///< of each lane, since the beginning
  LaneWork* photon_[kWidth];
  std::uint32_t begun_[kWidth];
  Numbers3 position_, direction_, polarisation_;
  Numbers path_, time_, depth_, interactions_, cosine_, face_, code_;
};

}  // namespace
}  // namespace scintray::transport
