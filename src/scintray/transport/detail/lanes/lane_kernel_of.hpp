#pragma once
/// The kernel of lane_kernel.hpp for one instruction set. Included by one file for each.

#include <limits>
#include <utility>

#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// The photons in the lanes of one vector. Their numbers are in memory between passes: a photon enters and
/// leaves its lane by as many loads and stores as it has numbers.
///
/// @tparam Walls  LaneFlatWalls or LaneBodyWalls, of a number type
template <typename Walls>
class LaneSet {
  using Real = typename Walls::Number;
  using Mask = typename Real::Mask;
  using Vector = core::Triple<Real>;
  using Numbers = LaneNumbers<Real>;
  using Numbers3 = LaneNumbers3<Real>;

 public:
  using Region = typename Walls::Region;
  static constexpr std::size_t kWidth = Real::kWidth;

  /// @param any  a photon, whose numbers serve lanes without one
  LaneSet(const typename Walls::Region& region, const LaneLimits& limits, const LaneWork& any)
      : walls_(region), limits_(limits) {
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
    const Real one(1.0);
    ++segments_;
    const Vector position = position_.load();
    const optics::LightRay<Real> light{direction_.load(), polarisation_.load()};
    const Vector centre = centre_.load();
    const typename Walls::Ahead ahead = walls_.nearest(position - centre, light.direction);
    const Real nearest = ahead.distance_mm;
    const Real depth = attenuation_.load() * nearest, depth_left = depth_.load();
    Mask misses = depth > depth_left;
    const Mask bulk = misses;
    Vector there = position + nearest * light.direction;
    const auto at = walls_.arrive(ahead, light.direction, centre, there);
    if constexpr (!Walls::kEncloses) misses = misses | walls_.none(ahead);
    const Mask total = totally_reflected(at.cosine, at.least_sin2);
    const Real path = path_.load(), time = time_.load();
    const Real there_path = path + nearest, there_depth = depth_left - depth,
               there_time = time + time_along(nearest, group_.load());
    const Mask goes_on = total & (there_time <= Real(limits_.time_ns)) & !misses;
    const unsigned ended = busy_ & ~lanes_of(goes_on);
    const auto count = static_cast<double>(segments_);
    if (ended == 0 && count < first_limit_) {
      const optics::LightRay<Real> reflected = Walls::reflected(ahead, at, light);
      position_.store(there);
      direction_.store(reflected.direction), polarisation_.store(reflected.polarisation);
      path_.store(there_path), time_.store(there_time), depth_.store(there_depth);
      walls_.leave(ahead);
      return 0;
    }
    const Mask stays = misses | (at.least_sin2 > Real(0.5 * (kNoTotalReflection + kManyRegions)));
    walls_.leave(ahead, stays);
    const Mask turns = total & !stays;
    position_.store(select(stays, position, there));
    path_.store(select(stays, path, there_path));
    time_.store(select(stays, time, there_time));
    depth_.store(select(stays, depth_left, there_depth));
    const optics::LightRay<Real> after = select(turns, Walls::reflected(ahead, at, light), light);
    direction_.store(after.direction), polarisation_.store(after.polarisation);
    const Real interactions = interactions_before_.load() + Real(count) - where(!turns, one);
    interactions_.store(interactions);
    cosine_.store(at.cosine);
    face_.store(Walls::face(ahead));
    code_.store(select(stays, where(bulk, one), select(total, Real(3.0), Real(2.0))));
    return busy_ & ~lanes_of(goes_on & (interactions < Real(limits_.interactions)));
  }
  /// Ends a photon that pass() has returned.
  void end(std::size_t lane) {
    constexpr LaneEnd kEnds[] = {LaneEnd::unclear, LaneEnd::bulk, LaneEnd::boundary, LaneEnd::total};
    const LaneEnd how = kEnds[static_cast<int>(code_.of[lane])];
    LaneWork& photon = *photon_[lane];
    photon.cosine = cosine_.of[lane];
    photon.face = static_cast<std::uint32_t>(face_.of[lane]);
    photon.interactions = interactions_.of[lane];
    give_back(lane, how, segments_ - begun_[lane] - (how == LaneEnd::unclear ? 1 : 0));
  }
  void end_unfinished() {
    for (; busy_ != 0;) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(busy_));
      photon_[lane]->interactions += segments_ - begun_[lane];
      give_back(lane, LaneEnd::unfinished, segments_ - begun_[lane]);
    }
  }

 private:
  void set(std::size_t lane, const LaneWork& photon) {
    position_.set(lane, photon.position);
    direction_.set(lane, photon.direction);
    polarisation_.set(lane, photon.polarisation);
    centre_.set(lane, photon.centre);
    path_.of[lane] = photon.path_mm;
    time_.of[lane] = photon.time_ns;
    depth_.of[lane] = photon.depth_left;
    group_.of[lane] = photon.group_index;
    attenuation_.of[lane] = photon.attenuation_per_mm;
    interactions_before_.of[lane] = photon.interactions - static_cast<double>(segments_);
    walls_.set(lane, photon);
  }
  void give_back(std::size_t lane, LaneEnd how, std::uint32_t segments) {
    LaneWork& photon = *photon_[lane];
    position_.get(lane, photon.position);
    direction_.get(lane, photon.direction);
    polarisation_.get(lane, photon.polarisation);
    photon.path_mm = path_.of[lane];
    photon.time_ns = time_.of[lane];
    photon.depth_left = depth_.of[lane];
    walls_.get(lane, photon);
    photon.segments = segments;
    photon.end = how;
    busy_ &= ~(1u << lane);
  }

  Walls walls_;
  const LaneLimits limits_;
  unsigned busy_ = 0;
  std::uint32_t segments_ = 0;  ///< of each lane, since the beginning
  double first_limit_ = std::numeric_limits<double>::infinity();
  LaneWork* photon_[kWidth];
  std::uint32_t begun_[kWidth];
  Numbers3 position_, direction_, polarisation_, centre_;
  Numbers path_, time_, depth_, group_, attenuation_, interactions_before_;
  // Of photons that end.
  Numbers interactions_, cosine_, face_, code_;
};

/// Propagates photons in several sets of lanes in turns, so that a processor works on one of them while it
/// waits for another. A lane whose photon has ended is filled with the next one at once.
///
/// @tparam Set  LaneSet or LaneBoxSet
template <typename Set, int kSets>
class LanePropagation {
  struct Sets {
    Set of[kSets];
  };
  template <std::size_t... kIndices>
  [[gnu::always_inline]] static Sets sets(const typename Set::Region& region, const LaneLimits& limits,
                                          const LaneWork& any, std::index_sequence<kIndices...>) {
    return {{(static_cast<void>(kIndices), Set(region, limits, any))...}};
  }
  /// Photons in fewer lanes than this are handed back unfinished when there is no other to fill lanes with.
  static constexpr int kFew = static_cast<int>(Set::kWidth) * kSets / 2;

 public:
  [[gnu::flatten]] static void run(const typename Set::Region& region, const LaneLimits& limits,
                                   LaneWork* photons, std::size_t count) {
    Sets lanes = sets(region, limits, *photons, std::make_index_sequence<kSets>());
    LaneWork *next = photons, *const last = photons + count;
    int busy = 0;
    for (std::size_t lane = 0; lane < Set::kWidth; ++lane)
      for (Set& set : lanes.of) {
        if (next == last) break;
        set.fill(lane, *next++);
        ++busy;
      }
    const bool hands_back = static_cast<int>(count) > busy;
    while (busy != 0) {
      for (Set& set : lanes.of) {
        if (set.busy() == 0) continue;
        for (unsigned ended = set.pass(); ended != 0; ended &= ended - 1) {
          const auto lane = static_cast<std::size_t>(__builtin_ctz(ended));
          set.end(lane);
          if (next != last)
            set.fill(lane, *next++);
          else
            --busy;
        }
      }
      if (hands_back && next == last && busy < kFew) {
        for (Set& set : lanes.of) set.end_unfinished();
        return;
      }
    }
  }
};

}  // namespace
}  // namespace scintray::transport
