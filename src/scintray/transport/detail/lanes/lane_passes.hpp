#pragma once
/// The kernel of lane_pool.hpp for one instruction set. Included by one file for each.
///
/// Photons are regrouped by what they reach: a pass takes photons of one state, that of most in the pool,
/// into the lanes and carries them through this stage and those that follow (lane_state), as long as most
/// lanes take part; then they return to the pool. Photons that are not in a stage are masked. Time is
/// proportional to instructions, so the rejection sampling of facets is repeated on its own.

#include "scintray/transport/detail/box_reflections.hpp"
#include "scintray/transport/detail/lanes/lane_surfaces.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

template <typename Real, bool kOneWavelength>
class LanePasses : LaneSurfaces<Real, kOneWavelength> {
  using Surfaces = LaneSurfaces<Real, kOneWavelength>;
  using Surfaces::attenuation_per_mm_;
  using Surfaces::boxes;
  using Surfaces::centre_;
  using Surfaces::cos_before_;
  using Surfaces::depth_left_;
  using Surfaces::face_of;
  using Surfaces::group_index_;
  using Surfaces::index_;
  using Surfaces::interact_with_table;
  using Surfaces::interactions_;
  using Surfaces::kWidth;
  using Surfaces::load;
  using Surfaces::load_faces;
  using Surfaces::nearest_plane;
  using Surfaces::number_of_lanes;
  using Surfaces::one_if;
  using Surfaces::one_of;
  using Surfaces::pass_microsurface;
  using Surfaces::path_mm_;
  using Surfaces::photon_;
  using Surfaces::plane_;
  using Surfaces::polarise;
  using Surfaces::pool_;
  using Surfaces::position_;
  using Surfaces::put_back;
  using Surfaces::reflect_at_reflector;
  using Surfaces::row_of;
  using Surfaces::segments_;
  using Surfaces::store;
  using Surfaces::take;
  using Surfaces::take_places;
  using Surfaces::time_ns_;
  using typename Surfaces::Bits;
  using typename Surfaces::Changed;
  using typename Surfaces::Light;
  using typename Surfaces::Mask;
  using typename Surfaces::Now;
  using typename Surfaces::Vector;
  /// Photons go on to their next stage when it has at least this number of lanes; else they return to the
  /// pool.
  static constexpr int kManyLanes = static_cast<int>(kWidth) * 3 / 4;
  /// The scalar code is called when as many photons wait for it: handing over each alone would take longer.
  static constexpr int kManyWait = 16;

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
    Changed changed;
    for (;;) {
      if (const Mask here = now.state == Real(lane_state::kPropagate); is_time(here)) {
        if (!changed.places) take_places();
        changed.places = true;
        propagate(now, here);
        continue;
      }
      if (const Mask here = now.state == Real(lane_state::kAcross); pool_.has_gaps && is_time(here)) {
        if (!changed.places) take_places();
        changed.places = true;
        cross_gap(now, here);
        continue;
      }
      if (!changed.surface) {
        const Mask there =
            (now.state > Real(lane_state::kAcross)) & (now.state < Real(lane_state::kFirstWaiting));
        if (number_of_lanes(there) < needed) break;
        changed.surface = true;
        if (!changed.places) load_faces(now);
      }
      if (!interact(now, is_time)) break;
      if (const Mask here = now.state == Real(lane_state::kThrough); any(here)) {
        if (!pool_.has_neighbours) {
          now.state = select(here, Real(lane_state::kCrossed), now.state);
          continue;
        }
        if (!changed.places) take_places();
        changed.places = true;
        if (enter_next(now, here)) changed.region = true;
      }
    }
    put_back(now, changed);
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

  /// A segment to a face.
  struct Hop {
    Mask known;  ///< its face is
    Real distance_mm, cosine;
  };
  /// Through total reflections in regions that unfold, as UnfoldedPropagation.
  void pass_reflections(Now& now, const Mask& here) {
    using Faces = typename BoxAxis<Real>::Faces;
    static constexpr LaneRecord kNever[2] = {
        {{kNoTotalReflection, kNoTotalReflection, kNoTotalReflection, kNoTotalReflection}},
        {{kNoTotalReflection, kNoTotalReflection, kNoTotalReflection, kNoTotalReflection}}};
    const double *mirrors[kWidth], *places[kWidth];
    std::uint32_t some = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const LaneRegion& region = photon_[lane]->region;
      mirrors[lane] = one_of(region.unfolds, photon_[lane]->optics + region.mirrors, kNever)->of;
      places[lane] = region.box->first_mm;
      some |= region.unfolds;
    }
    if (some == 0) return;
    const LaneFours<Real> sin2 = row_of(mirrors, 0), last_sin2 = row_of(mirrors, 1);
    const LaneFours<Real> first = row_of(places, 0), second = row_of(places, 1),
                          per_length = row_of(places, 2);
    const Faces faces[3] = {{first.of[0], second.of[0], per_length.of[0], sin2.of[0], sin2.of[1]},
                            {first.of[1], second.of[1], per_length.of[1], sin2.of[2], sin2.of[3]},
                            {first.of[2], second.of[2], per_length.of[2], last_sin2.of[0], last_sin2.of[1]}};
    const Vector position = load(position_), centre = load(centre_);
    const Real depth_left = load(depth_left_), attenuation = load(attenuation_per_mm_), time = load(time_ns_);
    const Real time_per_mm = time_along(Real(1.0), load(group_index_)), interactions = load(interactions_);
    // Lanes in other states have no interactions left.
    const BoxReflections<Real> passed(faces, position - centre, now.light,
                                      {depth_left, attenuation, Real(pool_.most_time_ns) - time, time_per_mm,
                                       where(here, Real(pool_.most_interactions) - interactions)});
    store(position_, passed.position(position, centre));
    now.light = passed.light();
    store(path_mm_, load(path_mm_) + passed.path_mm);
    store(time_ns_, time + passed.path_mm * time_per_mm);
    store(depth_left_, depth_left - attenuation * passed.path_mm);
    store(interactions_, interactions + passed.count);
    store(segments_, load(segments_) + passed.count);
  }

  /// To the next plane, and through a total reflection there.
  void propagate(Now& now, const Mask& here) {
    if (pool_.unfolds) pass_reflections(now, here);
    const Vector local = load(position_) - load(centre_);
    if (pool_.boxes) {
      const Vector& direction = now.light.direction;
      const Real one(1.0);
      const LaneBoxAhead<Real> ahead(
          boxes(), local, direction,
          {one / magnitude(direction.x), one / magnitude(direction.y), one / magnitude(direction.z)});
      const Real along = ahead.along(direction);
      store(plane_, select(here, ahead.face(along), load(plane_)));
      load_faces(now);
      const Hop hop{here, ahead.distance_mm, magnitude(along)};
      move<false>(now, here, hop, [&ahead](const Mask& lanes, const Light& light) {
        const LaneSigns<Real> signs = ahead.signs();
        const Bits there = bits_of(where(lanes, Real(-0.0)));
        const LaneSigns<Real> turned{signs.x & there, signs.y & there, signs.z & there};
        return Light{
            turned.of(light.direction),
            LaneSigns<Real>{turned.x ^ there, turned.y ^ there, turned.z ^ there}.of(light.polarisation)};
      });
      return;
    }
    const LaneAhead<Real> ahead = nearest_plane(local, now.light.direction);
    store(plane_, select(here, ahead.plane, load(plane_)));
    load_faces(now);
    const Hop hop{here, ahead.distance_mm, dot(now.light.direction, now.normal)};
    move<false>(now, here, hop, [&now](const Mask& lanes, const Light& light) {
      return optics::reflected_where(lanes, light, now.normal);
    });
  }

  /// Across the first gap in front of the face to the face beyond, as scene::Accelerator::exit_across_gap().
  /// Photons that are beside it, or have another beyond it, wait for the scalar code.
  void cross_gap(Now& now, const Mask& here) {
    static constexpr LaneGap kNone{};
    const unsigned lanes = lanes_of(here);
    const double* gaps[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const LaneFace& face = photon_[lane]->region.faces[static_cast<std::uint32_t>(plane_[lane])];
      gaps[lane] = one_of(lanes >> lane & 1, face.gap, &kNone)->normal;
    }
    const LaneFours<Real> plane = row_of(gaps, 0), first = row_of(gaps, 1), second = row_of(gaps, 2),
                          last = row_of(gaps, 3);
    const Vector local = load(position_) - load(centre_), direction = now.light.direction;
    const Vector normal{plane.of[0], plane.of[1], plane.of[2]};
    const Vector x{first.of[0], first.of[1], first.of[2]}, y{second.of[0], second.of[1], second.of[2]};
    const Real at_x = dot(x, local), at_y = dot(y, local);
    const auto contains = [&](const Real& along_x, const Real& along_y) {
      return (along_x >= first.of[3]) & (along_x <= last.of[0]) & (along_y >= second.of[3]) &
             (along_y <= last.of[1]);
    };
    // As Accelerator::approach_of(), in its order of additions.
    const Real cosine = (normal.x * direction.x + normal.z * direction.z) + normal.y * direction.y;
    const Real height = (normal.x * local.x + normal.z * local.z) + (normal.y * local.y - plane.of[3]);
    const Real ahead = -height / cosine, zero(0.0);
    const Real distance = where(ahead > zero, ahead);
    const Mask found = here & (cosine > zero) & contains(at_x, at_y) &
                       contains(at_x + distance * dot(x, direction), at_y + distance * dot(y, direction));
    store(plane_, select(found, last.of[2], load(plane_)));
    load_faces(now);
    move<true>(now, here, {found, where(found, distance), dot(direction, now.normal)},
               [](const Mask&, const Light& light) { return light; });
  }

  /// Along a segment to a face, and in a region bounded by planes through a total reflection there.
  /// @param known  its face is
  template <bool kAcross, typename Reflect>
  void move(Now& now, const Mask& here, const Hop& hop, const Reflect& reflect) {
    const Mask& known = hop.known;
    const Real &distance = hop.distance_mm, &cosine = hop.cosine;
    const Vector position = load(position_), direction = now.light.direction;
    const Real depth = load(attenuation_per_mm_) * distance, depth_left = load(depth_left_);
    const Mask total = totally_reflected(cosine, now.least_sin2);
    const Mask bulk = known & (depth > depth_left);
    Mask unclear = (!known) | (now.kind == Real(lane_state::kUnclear));
    if constexpr (kAcross) unclear = unclear | total;  // the scalar code goes on with Embree
    const Mask moves = here & !(bulk | unclear);
    const Real path = load(path_mm_), time = load(time_ns_);
    // By no distance where a photon stays.
    const Real moved = where(moves, distance), there_time = time + time_along(moved, load(group_index_));
    store(position_, position + moved * direction);
    store(path_mm_, path + moved);
    store(time_ns_, there_time);
    store(depth_left_, depth_left - where(moves, depth));
    store(segments_, load(segments_) + one_if(here & (bulk | !unclear)));
    const Real interactions = load(interactions_) + where(moves, now.counted);
    store(interactions_, interactions);
    store(cos_before_, select(here, magnitude(cosine), load(cos_before_)));
    const Real stays = select(bulk, Real(lane_state::kBulk), Real(lane_state::kUnclear));
    if constexpr (kAcross) {
      now.state = select(here, select(moves, now.kind, stays), now.state);
    } else {
      now.light = reflect(moves & total, now.light);
      const Mask within =
          (interactions < Real(pool_.most_interactions)) & (there_time <= Real(pool_.most_time_ns));
      const Real after_total = select(within, Real(lane_state::kPropagate), Real(lane_state::kCut));
      now.state = select(here, select(moves, select(total, after_total, now.kind), stays), now.state);
    }
  }

  /// Into the region behind the face, where that is in lanes; else the photon waits.
  /// @return whether some photon has entered it
  bool enter_next(Now& now, const Mask& here) {
    const Mask within =
        (load(interactions_) < Real(pool_.most_interactions)) & (load(time_ns_) <= Real(pool_.most_time_ns));
    unsigned entering = 0, at_gaps = 0;
    const double* media[kWidth];
    const unsigned may = lanes_of(here & within);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      LanePhoton& photon = *photon_[lane];
      const LaneRegion* const behind = face_of(now, lane).behind;
      const unsigned enters = may >> lane & (behind != nullptr ? 1U : 0U);
      const LaneRegion* const next = one_of(enters, behind, static_cast<const LaneRegion*>(&photon.region));
      photon.region = *next;
      media[lane] = photon.optics[next->medium].of;
      entering |= enters << lane;
      at_gaps |= photon.region.has_gaps << lane;
    }
    if (entering == 0) {
      now.state = select(here, Real(lane_state::kCrossed), now.state);
      return false;
    }
    const Mask enters = Mask::of(entering);
    const LaneFours<Real> there = row_of(now.face, 4);
    LaneFours<Real> medium;
    load_fours(media, medium);
    const auto set = [&enters](auto& to, const Real& value) { store(to, select(enters, value, load(to))); };
    for (std::size_t axis = 0; axis < 3; ++axis) set(centre_[axis], there.of[axis]);
    set(plane_, there.of[3]);
    set(index_, medium.of[0]);
    set(group_index_, medium.of[1]);
    set(attenuation_per_mm_, medium.of[2]);
    now.side = select(enters, Real(1.0), now.side);
    const Real moving = select(Mask::of(at_gaps), Real(lane_state::kAcross), Real(lane_state::kPropagate));
    now.state = select(here, select(enters, moving, Real(lane_state::kCrossed)), now.state);
    return true;
  }
};

/// Inlined, so that a profile has the time under the name of the kernel, which is known outside its file.
template <typename Real>
[[gnu::always_inline]] inline void run_passes(LanePool& pool) {
  if (pool.one_wavelength)
    LanePasses<Real, true>(pool).run();
  else
    LanePasses<Real, false>(pool).run();
}

}  // namespace
}  // namespace scintray::transport
