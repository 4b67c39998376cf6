#pragma once
/// The kernel of lane_pool.hpp for one instruction set. Included by one file for each.
///
/// Photons are regrouped by what they reach: a pass takes photons of one state, that of most in the pool,
/// into the lanes and carries them through this stage and those that follow (lane_state), as long as most
/// lanes take part; then they return to the pool. Photons that are not in a stage are masked. Time is
/// proportional to instructions, so the rejection sampling of facets is repeated on its own.

#include "scintray/transport/detail/lanes/lane_surfaces.hpp"

namespace scintray::transport {
namespace {

template <typename Real, LaneDraws kDraws, bool kOneWavelength>
class LanePasses : LaneSurfaces<Real, kDraws, kOneWavelength> {
  using Surfaces = LaneSurfaces<Real, kDraws, kOneWavelength>;
  using Surfaces::cross_gap;
  using Surfaces::enter_next;
  using Surfaces::interact_with_table;
  using Surfaces::interactions_;
  using Surfaces::kWidth;
  using Surfaces::load;
  using Surfaces::load_faces;
  using Surfaces::number_of_lanes;
  using Surfaces::pass_microsurface;
  using Surfaces::photon_;
  using Surfaces::polarise;
  using Surfaces::pool_;
  using Surfaces::propagate;
  using Surfaces::put_back;
  using Surfaces::reflect_at_reflector;
  using Surfaces::take;
  using Surfaces::take_numbers;
  using Surfaces::take_places;
  using Surfaces::time_ns_;
  using typename Surfaces::Mask;
  using typename Surfaces::Now;
  /// Photons go on to their next stage when it has at least this number of lanes; else they return to the
  /// pool.
  static constexpr int kManyLanes = static_cast<int>(kWidth) * 3 / 4;
  /// The scalar code is called when as many photons wait for it: handing over each alone would take longer.
  static constexpr int kManyWait = 8;

 public:
  explicit LanePasses(LanePool& pool) : Surfaces(pool) {}

  void run() {
    for (;;) {
      int most = 0;
      std::size_t state = 0;
      for (std::size_t i = lane_state::kFirstStage; i < lane_state::kEndOfStages; ++i) {
        const int count = __builtin_popcountll(pool_.in_state[i]);
        state = count > most ? i : state;
        most = count > most ? count : most;
      }
      const int waiting = number_waiting();
      if (waiting >= kManyWait || (waiting > 0 && most < static_cast<int>(kWidth))) return;
      pass(state);
    }
  }

 private:
  int number_waiting() const {
    std::uint64_t waiting = 0;
    for (std::size_t i = lane_state::kFirstOfWaiting; i < lane_state::kCount; ++i)
      waiting |= pool_.in_state[i];
    return __builtin_popcountll(waiting);
  }

  /// Carries photons that are in a state through this stage and those that follow.
  [[gnu::flatten]] void pass(std::size_t state) {
    Now now;
    take(state, now);
    int needed = 1;  // number of lanes for a stage, of which the first has fewer only where the pool has
    const auto is_time = [&needed](const Mask& here) {
      if (number_of_lanes(here) < needed) return false;
      needed = kManyLanes;
      return true;
    };
    bool has_moved = false, at_surface = false, has_entered = false;
    for (;;) {
      if (const Mask here = now.state == Real(lane_state::kPropagate); is_time(here)) {
        if (!has_moved) take_places();
        has_moved = true;
        propagate(now, here);
        continue;
      }
      if (const Mask here = now.state == Real(lane_state::kAcross); pool_.has_gaps && is_time(here)) {
        if (!has_moved) take_places();
        has_moved = true;
        cross_gap(now, here);
        continue;
      }
      if (!at_surface) {
        const Mask there =
            (now.state > Real(lane_state::kAcross)) & (now.state < Real(lane_state::kFirstWaiting));
        if (number_of_lanes(there) < needed) break;
        at_surface = true;
        if (!has_moved) load_faces(now);
        take_numbers();
      }
      if (!interact(now, is_time)) break;
      if (const Mask here = now.state == Real(lane_state::kThrough); any(here)) {
        if (!has_moved) take_places();
        has_moved = true;
        if (enter_next(now, here)) has_entered = true;
      }
    }
    put_back(now, has_moved, at_surface, has_entered);
  }

  /// The stages at a surface; false when none is passed.
  template <typename IsTime>
  bool interact(Now& now, const IsTime& is_time) {
    const auto in = [&now](double of) { return now.state == Real(of); };
    bool some = false;
    const Mask smooth = in(lane_state::kSmooth), facets = in(lane_state::kFacets);
    if (is_time(smooth | facets)) {
      pass_microsurface(now, smooth, facets);
      some = true;
    }
    if (const Mask here = in(lane_state::kTable); is_time(here)) {
      interact_with_table(now, here);
      some = true;
    }
    if (const Mask here = in(lane_state::kReflector); is_time(here)) {
      reflect_at_reflector(now, here);
      some = true;
    }
    if (const Mask here = in(lane_state::kPolarise); is_time(here)) {
      polarise(now, here);
      some = true;
    }
    if (const Mask here = in(lane_state::kReflected); any(here)) {
      const Mask within = (load(interactions_) < Real(pool_.most_interactions)) &
                          (load(time_ns_) <= Real(pool_.most_time_ns));
      Real moving(lane_state::kPropagate);
      if (pool_.has_gaps) {
        unsigned at_gaps = 0;
        for (std::size_t lane = 0; lane < kWidth; ++lane) at_gaps |= photon_[lane]->region.has_gaps << lane;
        moving = select(Mask::of(at_gaps), Real(lane_state::kAcross), moving);
      }
      now.state = select(here, select(within, moving, Real(lane_state::kCut)), now.state);
    }
    return some;
  }
};

/// Inlined, so that a profile has the time under the name of the kernel, which is known outside its file.
template <typename Real, LaneDraws kDraws>
[[gnu::always_inline]] inline void run_passes(LanePool& pool) {
  if (pool.one_wavelength)
    LanePasses<Real, kDraws, true>(pool).run();
  else
    LanePasses<Real, kDraws, false>(pool).run();
}

}  // namespace
}  // namespace scintray::transport
