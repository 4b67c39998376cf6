#pragma once
/// The kernel of lane_kernel.hpp for one instruction set. Included by one file for each.

#include <limits>

#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// The photons in the lanes of one vector. Their numbers are in memory between passes: a photon enters and
/// leaves its lane by as many loads and stores as it has numbers.
template <typename Real>
class LaneSlots {
 public:
  static constexpr std::size_t kWidth = Real::kWidth;

  /// A bit for each lane with a photon.
  unsigned busy() const { return busy_; }
  /// The end of a photon that pass() has returned.
  LaneEnd ending(std::size_t lane) const {
    constexpr LaneEnd kEnds[] = {LaneEnd::unclear, LaneEnd::bulk, LaneEnd::boundary, LaneEnd::total};
    return kEnds[static_cast<int>(code_.of[lane])];
  }

 protected:
  using Mask = typename Real::Mask;
  using Vector = core::Triple<Real>;
  using Numbers = LaneNumbers<Real>;
  using Numbers3 = LaneNumbers3<Real>;

  explicit LaneSlots(const LaneLimits& limits) : limits_(limits) {}

  /// Sets the numbers of a lane, to which a photon may belong, or none.
  void set(std::size_t lane, const LaneWork& photon) {
    position_.set(lane, photon.position);
    direction_.set(lane, photon.direction);
    centre_.set(lane, photon.centre);
    path_.of[lane] = photon.path_mm;
    time_.of[lane] = photon.time_ns;
    time_per_mm_.of[lane] = time_along(1.0, photon.group_index);
    depth_.of[lane] = photon.depth_left;
    attenuation_.of[lane] = photon.attenuation_per_mm;
    interactions_before_.of[lane] = photon.interactions - count();
  }
  void take(std::size_t lane, LaneWork& photon) {
    photon_[lane] = &photon;
    begun_[lane] = passes_;
    busy_ |= 1u << lane;
    const double last = count() + (limits_.interactions - photon.interactions);
    first_last_ = last < first_last_ ? last : first_last_;
  }
  /// A photon with all that the lanes share, once it has left its lane.
  struct Released {
    LaneWork& photon;
    std::uint32_t reflections;
  };
  /// @param how  unfinished, or as of ending()
  Released release(std::size_t lane, LaneEnd how) {
    LaneWork& photon = *photon_[lane];
    const std::uint32_t passes = passes_ - begun_[lane];
    const std::uint32_t reflections = passes - (how == LaneEnd::total || how == LaneEnd::unfinished ? 0 : 1);
    position_.get(lane, photon.position);
    photon.path_mm = path_.of[lane];
    photon.time_ns = time_.of[lane];
    photon.depth_left = depth_.of[lane];
    photon.interactions += reflections;
    photon.cosine = cosine_.of[lane];
    photon.face = static_cast<std::uint32_t>(face_.of[lane]);
    photon.segments = passes - (how == LaneEnd::unclear ? 1 : 0);
    photon.end = how;
    busy_ &= ~(1u << lane);
    return {photon, reflections};
  }

  double count() const { return static_cast<double>(passes_); }
  /// Whether some photon may have its last interaction in the next pass.
  bool may_be_last() const { return static_cast<double>(passes_ + 1) >= first_last_; }
  void count_pass() { ++passes_; }

  /// The ends of photons that a counted pass has moved.
  struct Ends {
    Mask stays, bulk, total, turns;  ///< stays: where it was, turns: is totally reflected
    Real face, cosine;
  };
  /// Keeps what ending() needs.
  /// @return a bit for each lane whose photon has ended
  unsigned keep(const Ends& ends, const Real& there_time) {
    face_.store(ends.face);
    cosine_.store(ends.cosine);
    code_.store(select(ends.stays, where(ends.bulk, Real(1.0)), select(ends.total, Real(3.0), Real(2.0))));
    const Real interactions = interactions_before_.load() + Real(count());
    const Mask within = (interactions < Real(limits_.interactions)) & (there_time <= Real(limits_.time_ns));
    return busy_ & ~lanes_of(ends.turns & within);
  }

  const LaneLimits limits_;
  Numbers3 position_, direction_, centre_;
  Numbers path_, time_, time_per_mm_, depth_, attenuation_;

 private:
  unsigned busy_ = 0;
  std::uint32_t passes_ = 0;
  double first_last_ = std::numeric_limits<double>::infinity();
  LaneWork* photon_[kWidth];
  std::uint32_t begun_[kWidth];
  Numbers interactions_before_;         ///< that it had at the first pass
  Numbers cosine_{}, face_{}, code_{};  ///< of photons that end
};

/// Photons in a region within walls.
///
/// @tparam Walls  LaneFlatWalls or LaneBodyWalls, of a number type
template <typename Walls>
class LaneSet : public LaneSlots<typename Walls::Number> {
  using Real = typename Walls::Number;
  using Slots = LaneSlots<Real>;
  using typename Slots::Mask;
  using typename Slots::Vector;

 public:
  using Region = typename Walls::Region;

  /// @param any  a photon, whose numbers serve lanes without one
  LaneSet(const Region& region, const LaneLimits& limits, const LaneWork& any)
      : Slots(limits), walls_(region) {
    for (std::size_t lane = 0; lane < Slots::kWidth; ++lane) set(lane, any);
  }

  void fill(std::size_t lane, LaneWork& photon) {
    set(lane, photon);
    Slots::take(lane, photon);
  }
  /// Moves all lanes by a segment.
  /// @return a bit for each lane whose photon has ended
  unsigned pass() {
    const Vector position = position_.load(), centre = centre_.load();
    const optics::LightRay<Real> light{direction_.load(), polarisation_.load()};
    const typename Walls::Ahead ahead = walls_.nearest(position - centre, light.direction);
    const Real distance = ahead.distance_mm;
    const Real depth = attenuation_.load() * distance, depth_left = depth_.load();
    const Mask bulk = depth > depth_left;
    Vector there = position + distance * light.direction;
    const auto at = walls_.arrive(ahead, light.direction, centre, there);
    Mask misses = bulk;
    if constexpr (!Walls::kEncloses) misses = misses | walls_.none(ahead);
    const Mask total = totally_reflected(at.cosine, at.least_sin2);
    const Real path = path_.load(), time = time_.load();
    const Real there_path = path + distance, there_depth = depth_left - depth,
               there_time = time + distance * time_per_mm_.load();
    const unsigned goes_on = lanes_of(total & (there_time <= Real(Slots::limits_.time_ns)) & !misses);
    const bool some_end = (Slots::busy() & ~goes_on) != 0 || Slots::may_be_last();
    Slots::count_pass();
    if (!some_end) {
      const optics::LightRay<Real> reflected = Walls::reflected(ahead, at, light);
      position_.store(there);
      direction_.store(reflected.direction), polarisation_.store(reflected.polarisation);
      path_.store(there_path), time_.store(there_time), depth_.store(there_depth);
      walls_.leave(ahead);
      return 0;
    }
    const Mask stays = misses | (at.least_sin2 > Real(0.5 * (kNoTotalReflection + kManyRegions)));
    const Mask turns = total & !stays;
    walls_.leave(ahead, stays);
    position_.store(select(stays, position, there));
    path_.store(select(stays, path, there_path));
    time_.store(select(stays, time, there_time));
    depth_.store(select(stays, depth_left, there_depth));
    const optics::LightRay<Real> after = select(turns, Walls::reflected(ahead, at, light), light);
    direction_.store(after.direction), polarisation_.store(after.polarisation);
    return Slots::keep({stays, bulk, total, turns, ahead.plane, at.cosine}, there_time);
  }
  /// Takes a photon out of its lane.
  void give_back(std::size_t lane, LaneEnd how) {
    LaneWork& photon = Slots::release(lane, how).photon;
    direction_.get(lane, photon.direction);
    polarisation_.get(lane, photon.polarisation);
    walls_.get(lane, photon);
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

  void set(std::size_t lane, const LaneWork& photon) {
    Slots::set(lane, photon);
    polarisation_.set(lane, photon.polarisation);
    walls_.set(lane, photon);
  }

  Walls walls_;
  typename Slots::Numbers3 polarisation_;
};

/// Propagates photons in lanes. One whose photon has ended is filled with the next one at once.
///
/// @tparam Set  LaneSet
template <typename Set>
class LanePropagation {
  /// Photons in fewer lanes than this are handed back unfinished when there is no other to fill lanes with.
  static constexpr int kFew = static_cast<int>(Set::kWidth) / 2;

 public:
  [[gnu::flatten]] static void run(const typename Set::Region& region, const LaneLimits& limits,
                                   LaneWork* const* photons, std::size_t count) {
    Set lanes(region, limits, **photons);
    LaneWork *const *next = photons, *const *const last = photons + count;
    int busy = 0;
    for (std::size_t lane = 0; lane < Set::kWidth && next != last; ++lane) {
      lanes.fill(lane, **next++);
      ++busy;
    }
    const bool hands_back = static_cast<int>(count) > busy;
    while (busy != 0) {
      for (unsigned ended = lanes.pass(); ended != 0; ended &= ended - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(ended));
        lanes.give_back(lane, lanes.ending(lane));
        if (next != last)
          lanes.fill(lane, **next++);
        else
          --busy;
      }
      if (hands_back && next == last && busy < kFew) {
        while (lanes.busy() != 0)
          lanes.give_back(static_cast<std::size_t>(__builtin_ctz(lanes.busy())), LaneEnd::unfinished);
        return;
      }
    }
  }
};

}  // namespace
}  // namespace scintray::transport
