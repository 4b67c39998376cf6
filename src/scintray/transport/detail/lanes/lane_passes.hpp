#pragma once
/// The kernel of lane_pool.hpp for one instruction set. Included by one file for each.
///
/// Photons are regrouped by what they reach: a pass takes photons of one state, that of most in the pool,
/// into the lanes and carries them through this stage and those that follow (lane_state), as long as most
/// lanes take part; then they return to the pool. Photons that are not in a stage are masked. Time is
/// proportional to instructions, so the rejection sampling of facets is repeated on its own.

#include "scintray/core/sampling_laws.hpp"
#include "scintray/optics/facet_laws.hpp"
#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/transport/detail/lanes/lane_photons.hpp"
#include "scintray/transport/detail/lanes/lane_planes.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {
namespace {

/// @tparam kOneWavelength  LanePool::one_wavelength
template <typename Real, LaneDraws kDraws, bool kOneWavelength>
class LanePasses : LanePhotons<Real, kDraws> {
  using Photons = LanePhotons<Real, kDraws>;
  using Photons::attenuation_per_mm_;
  using Photons::centre_;
  using Photons::choose;
  using Photons::cos_before_;
  using Photons::count_drawn;
  using Photons::depth_left_;
  using Photons::draw;
  using Photons::group_index_;
  using Photons::index_;
  using Photons::interactions_;
  using Photons::kWidth;
  using Photons::load;
  using Photons::next_;
  using Photons::next_number;
  using Photons::next_numbers;
  using Photons::number_of_lanes;
  using Photons::one_if;
  using Photons::path_mm_;
  using Photons::photon_;
  using Photons::plane_;
  using Photons::pool_;
  using Photons::position_;
  using Photons::put_back;
  using Photons::segments_;
  using Photons::store;
  using Photons::take;
  using Photons::take_numbers;
  using Photons::take_places;
  using Photons::time_ns_;
  using typename Photons::Bits;
  using typename Photons::Light;
  using typename Photons::Mask;
  using typename Photons::Moving;
  using typename Photons::Random;
  using typename Photons::Vector;
  /// Facets are redrawn until at most this number of lanes lacks one; those wait for the next pass.
  static constexpr int kFewLanes = static_cast<int>(kWidth / 4);
  /// Photons go on to their next stage when it has at least this number of lanes; else they return to the
  /// pool.
  static constexpr int kManyLanes = static_cast<int>(kWidth) * 3 / 4;
  /// The scalar code is called when as many photons wait for it: handing over each alone would take longer.
  static constexpr int kManyWait = 8;

 public:
  explicit LanePasses(LanePool& pool) : Photons(pool) {}

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

  /// The plane that a photon is at.
  struct Now : Moving {
    Vector normal;  ///< of the plane, out of the region
    Real kind, index_behind, least_sin2, counted, reflector;
    const double* face[kWidth];    ///< LaneFace
    const double* optics[kWidth];  ///< LaneFaceOptics; not set with one wavelength
  };

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

  // Planes and faces.

  void load_faces(Now& now) const {
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const LaneFace& face = photon_[lane]->region.faces[static_cast<std::size_t>(plane_[lane])];
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
    const double* at[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) at[lane] = of[lane] + 4 * which;
    LaneFours<Real> fours;
    load_fours(at, fours);
    return fours;
  }
  static const LaneFace& face_of(const Now& now, std::size_t lane) {
    return *reinterpret_cast<const LaneFace*>(now.face[lane]);
  }

  LaneAhead<Real> nearest_plane(const Vector& local, const Vector& direction) const {
    LaneAhead<Real> nearest;
    const LaneRegion& one = photon_[0]->region;
    bool same = true;
    std::size_t count = one.count;
    for (std::size_t lane = 1; lane < kWidth; ++lane) {
      const LaneRegion& region = photon_[lane]->region;
      same = same && region.planes == one.planes;
      count = region.count > count ? region.count : count;
    }
    if (same) {
      for (std::size_t i = 0; i < count; ++i) {
        const PlanePair& planes = one.planes[i];
        nearest.take({Real(planes.normal[0]), Real(planes.normal[1]), Real(planes.normal[2])},
                     Real(planes.first_mm), Real(planes.second_mm), local, direction,
                     2.0 * static_cast<double>(i));
      }
      return nearest;
    }
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

  // Stages.

  /// To the next plane, and through a total reflection there.
  void propagate(Now& now, const Mask& here) {
    const LaneAhead<Real> ahead = nearest_plane(load(position_) - load(centre_), now.light.direction);
    const Real zero(0.0);
    const Real distance = select(ahead.distance_mm < zero, zero, ahead.distance_mm);
    store(plane_, select(here, ahead.plane, load(plane_)));
    move<false>(now, here, here, distance);
  }

  /// Across the first gap in front of the face to the face beyond, as scene::Accelerator::exit_across_gap().
  /// Photons that are beside it, or have another beyond it, wait for the scalar code.
  void cross_gap(Now& now, const Mask& here) {
    static constexpr LaneGap kNone{};
    const unsigned lanes = lanes_of(here);
    const double* gaps[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const LaneFace& face = photon_[lane]->region.faces[static_cast<std::size_t>(plane_[lane])];
      gaps[lane] = ((lanes >> lane & 1) != 0 ? face.gap : &kNone)->normal;
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
    const Real distance = select(ahead > zero, ahead, zero);
    const Mask found = here & (cosine > zero) & contains(at_x, at_y) &
                       contains(at_x + distance * dot(x, direction), at_y + distance * dot(y, direction));
    store(plane_, select(found, last.of[2], load(plane_)));
    move<true>(now, here, found, select(found, distance, zero));
  }

  /// Along a segment to a face, and in a region bounded by planes through a total reflection there.
  /// @param known  its face is
  template <bool kAcross>
  void move(Now& now, const Mask& here, const Mask& known, const Real& distance) {
    load_faces(now);
    const Real zero(0.0);
    const Vector position = load(position_), direction = now.light.direction;
    const Real depth = load(attenuation_per_mm_) * distance, depth_left = load(depth_left_);
    const Real cosine = dot(direction, now.normal);
    const Mask total = totally_reflected(cosine, now.least_sin2);
    const Mask bulk = known & (depth > depth_left);
    Mask unclear = (!known) | (now.kind == Real(lane_state::kUnclear));
    if constexpr (kAcross) unclear = unclear | total;  // the scalar code goes on with Embree
    const Mask moves = here & !(bulk | unclear);
    const Real path = load(path_mm_), time = load(time_ns_);
    const Real there_time = time + time_along(distance, load(group_index_));
    store(position_, select(moves, position + distance * direction, position));
    store(path_mm_, select(moves, path + distance, path));
    store(time_ns_, select(moves, there_time, time));
    store(depth_left_, select(moves, depth_left - depth, depth_left));
    store(segments_, load(segments_) + one_if(here & (bulk | !unclear)));
    const Real interactions = load(interactions_) + select(moves, now.counted, zero);
    store(interactions_, interactions);
    store(cos_before_, select(here, magnitude(cosine), load(cos_before_)));
    const Real stays = select(bulk, Real(lane_state::kBulk), Real(lane_state::kUnclear));
    if constexpr (kAcross) {
      now.state = select(here, select(moves, now.kind, stays), now.state);
    } else {
      now.light = select(moves & total, reflected(now.light, now.normal), now.light);
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
      const bool enters = (may >> lane & 1) != 0 && behind != nullptr;
      photon.region = *(enters ? behind : &photon.region);
      media[lane] = photon.optics[photon.region.medium].of;
      entering |= (enters ? 1U : 0U) << lane;
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

  /// Smooth surfaces, and facets, for which one is drawn first; where none is accepted the photon stays.
  void pass_microsurface(Now& now, const Mask& smooth, const Mask& facets) {
    const Vector against = -now.side * now.normal;
    Vector m = against;
    Mask pending = facets;
    if (any(facets)) {
      const LaneFours<Real> more = optics_of(now, 1), last = optics_of(now, 2);
      const Mask by_area = last.of[0] > Real(0.0);
      const optics::FacetNumbers<Real> numbers{more.of[0], more.of[1], more.of[2], more.of[3], by_area};
      do {
        draw(pending, 4.0);
        const Random random = next_numbers();
        const optics::FacetDraw<Real> facet(
            numbers, now.light.direction, against,
            {random.uniform_positive(0), random.uniform(1), random.uniform(2), random.uniform(3)});
        const Mask found = pending & facet.accepted;
        m = select(found, facet.normal, m);
        count_drawn(select(pending, facet.drawn, Real(0.0)));
        pending = pending & !facet.accepted;
      } while (number_of_lanes(pending) > kFewLanes);
    }
    const Mask ready = smooth | (facets & !pending);
    draw(ready, 1.0);
    const Bits for_fresnel = next_number();
    const Mask inside = now.side > Real(0.0);
    const Real index = load(index_);
    const Refracted after = refract(now.light, m, select(inside, index, now.index_behind),
                                    select(inside, now.index_behind, index), for_fresnel);
    now.light = select(ready, after.light, now.light);
    now.side = select(ready & after.transmitted, -now.side, now.side);
    const Real outward = now.side * dot(now.light.direction, now.normal);
    const Mask left = ready & (smooth | (outward < Real(0.0)));
    const Real through =
        select(now.reflector > Real(0.0), Real(lane_state::kReflector), Real(lane_state::kThrough));
    const Real next = select(now.side > Real(0.0), Real(lane_state::kReflected), through);
    now.state = select(left, next, now.state);
    count_drawn(one_if(ready & after.drawn));
  }

  struct Refracted {
    Light light;
    Mask transmitted;
    Mask drawn;  ///< the random number was used
  };
  /// As optics::interact_at_facet.
  static Refracted refract(const Light& light, const Vector& m, const Real& n1, const Real& n2,
                           const Bits& random) {
    const Real cos_i = cos_incidence(light, m);
    const optics::RefractionOf<Real> refraction(cos_i, n1, n2);
    const Mask total = refraction.total(), unpolarised = is_zero(light.polarisation);
    optics::FacetLight<Real> facet(light, m, cos_i, refraction, n1, n2);
    const Mask straight = (!unpolarised) & (refraction.sin2_i < Real(optics::kNormalIncidence));
    const Real polarised = facet.polarised_reflectance();
    const Real reflectance = select(unpolarised, facet.unpolarised_reflectance(),
                                    select(straight, facet.reflectance_s(), polarised));
    const Mask transmitted = (!total) & (core::uniform_of<Real>(random) >= reflectance);
    const Light mirrored = optics::reflected(light, m);
    const Vector direction =
        select(transmitted, select(straight, light.direction, facet.refracted()), mirrored.direction);
    Vector polarisation = facet.polarised(transmitted, direction);
    polarisation = select(unpolarised | (straight & transmitted), light.polarisation, polarisation);
    polarisation = select(total | (straight & !transmitted), mirrored.polarisation, polarisation);
    return {{direction, polarisation}, transmitted, !total};
  }

  /// Table entries for each photon.
  struct LookedUp {
    const optics::TableView* view[kWidth];
    const optics::TableInterval* interval[kWidth];
    alignas(64) double several[kWidth];  ///< 1: one of two slices was drawn
    alignas(64) double absorbs[kWidth], transmits[kWidth];
  };
  /// @param first  random number that selects between slices
  LookedUp look_up(const Now& now, const Mask& here, const Real& slants, const Real& first) const {
    static constexpr optics::TableInterval kNone{};
    LookedUp found;
    alignas(64) double slant[kWidth], uniform[kWidth], side[kWidth];
    slants.store(slant), first.store(uniform), now.side.store(side);
    const unsigned lanes = lanes_of(here);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      found.interval[lane] = &kNone;
      found.several[lane] = found.absorbs[lane] = found.transmits[lane] = 0.0;
      if ((lanes >> lane & 1) == 0) continue;
      const LaneFaceOptics& face = kOneWavelength
                                       ? face_of(now, lane).at_one
                                       : *reinterpret_cast<const LaneFaceOptics*>(now.optics[lane]);
      const LaneTable& table = *face.table;
      found.view[lane] = &table.view[uniform[lane] < face.to_next ? 1 : 0][side[lane] > 0.0 ? 0 : 1];
      found.interval[lane] = &optics::interval_at(*found.view[lane], slant[lane]);
      found.several[lane] = face.to_next >= 0.0 ? 1.0 : 0.0;
      found.absorbs[lane] = table.absorbs ? 1.0 : 0.0;
      found.transmits[lane] = found.interval[lane]->transmits ? 1.0 : 0.0;
    }
    return found;
  }

  /// Directions of exit, each looked up at its levels.
  struct Exits {
    Real polar, azimuth;
  };
  static Exits exits_of(const LookedUp& found, const Mask& leaves, const Mask& reflected, const Real& shares,
                        const Real& polar_levels, const Real& azimuth_levels) {
    alignas(64) double share[kWidth], polar[kWidth], azimuth[kWidth];
    shares.store(share), polar_levels.store(polar), azimuth_levels.store(azimuth);
    const unsigned lanes = lanes_of(leaves), ways = lanes_of(reflected);
    optics::TableCell cells[kWidth];
    // What is seldom in the nearest cache is fetched for all lanes before the first waits for it.
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      if ((lanes >> lane & 1) == 0) continue;
      cells[lane] = optics::table_cell(*found.view[lane], *found.interval[lane],
                                       static_cast<int>(ways >> lane & 1), polar[lane], azimuth[lane]);
      __builtin_prefetch(cells[lane].azimuth_low);
      __builtin_prefetch(cells[lane].azimuth_high);
      __builtin_prefetch(cells[lane].polar_low);
      __builtin_prefetch(cells[lane].polar_low + found.view[lane]->nodes);
    }
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      if ((lanes >> lane & 1) == 0) continue;
      const optics::TableExit exit = optics::table_exit(*found.view[lane], cells[lane], share[lane]);
      polar[lane] = static_cast<double>(exit.polar);
      azimuth[lane] = static_cast<double>(exit.azimuth);
    }
    return {Real::load(polar), Real::load(azimuth)};
  }

  /// As optics::SurfaceTable::interact, of a table with folded azimuths.
  void interact_with_table(Now& now, const Mask& here) {
    const Real zero(0.0), one(1.0);
    const Real cosine = dot(now.light.direction, now.normal);
    const Vector lateral = now.light.direction - cosine * now.normal;
    const Real sine = root(dot(lateral, lateral));
    Vector forward{lateral.x / sine, lateral.y / sine, lateral.z / sine};
    Mask ready = here;
    const Mask no_plane = here & (sine <= Real(optics::kNoIncidencePlane));
    if (any(no_plane)) {
      draw(no_plane, 1.0);
      const core::CirclePoint<Real> point(next_number());
      count_drawn(one_if(no_plane));
      forward = select(no_plane, core::across_at<Real>(now.normal, point), forward);
      ready = here & !(no_plane & !point.accepted);
    }
    draw(ready, 4.0);
    const Random random = next_numbers();
    const Real slant = optics::slant_of<Real>(sine, magnitude(cosine));
    const LookedUp found = look_up(now, ready, slant, random.uniform(0));
    const double* numbers[kWidth];
    LaneFours<Real> first, second;
    for (std::size_t lane = 0; lane < kWidth; ++lane) numbers[lane] = &found.interval[lane]->start;
    load_fours(numbers, first);
    for (std::size_t lane = 0; lane < kWidth; ++lane) numbers[lane] = &found.interval[lane]->reflectance_step;
    load_fours(numbers, second);
    const Real share = optics::share_of<Real>(slant, first.of[0], first.of[1], first.of[2]);
    const Real reflectance = first.of[3] + share * second.of[0];
    const Real absorptance = second.of[1] + share * second.of[2];

    const Mask several = Real::load(found.several) > zero;
    const Real u = core::uniform_of<Real>(choose(several, random.bits[1], random.bits[0]));
    const Mask reflected = u < reflectance;
    const Mask absorbed = ready & (Real::load(found.absorbs) > zero) & !reflected &
                          ((!(Real::load(found.transmits) > zero)) | (u < reflectance + absorptance));
    const Mask leaves = ready & !absorbed;
    const Bits azimuth_bits = choose(several, random.bits[3], random.bits[2]);
    const Exits exits = exits_of(found, leaves, reflected, share,
                                 optics::level_of_two_tails<Real>(
                                     core::uniform_of<Real>(choose(several, random.bits[2], random.bits[1]))),
                                 optics::level_of_one_tail<Real>(core::uniform_of<Real>(azimuth_bits)));
    const core::SineCosineOf<Real> polar = core::laws::sincos<Real>(exits.polar);
    const Mask grazing = polar.cosine < Real(optics::kLeastExitCosine);
    const Real sin_polar = select(grazing, one, polar.sine);
    const Real cos_polar = select(grazing, Real(optics::kLeastExitCosine), polar.cosine);
    // A bit that u does not use: either side of the plane of incidence.
    const core::SineCosineOf<Real> azimuth =
        core::laws::sincos<Real>(number_of(bits_of(exits.azimuth) ^ (azimuth_bits << 63)));

    const Real after = select(reflected, now.side, -now.side);
    const Vector across = cross(now.normal, forward);
    const Vector direction =
        sin_polar * (azimuth.cosine * forward + azimuth.sine * across) + (-after * cos_polar) * now.normal;
    const Mask unpolarised = is_zero(now.light.polarisation);
    now.light.direction = select(leaves, direction, now.light.direction);
    now.side = select(leaves, after, now.side);
    const Real through =
        select(now.reflector > zero, Real(lane_state::kReflector), Real(lane_state::kThrough));
    const Real next = select(after > zero, Real(lane_state::kReflected), through);
    store(next_, select(leaves, next, load(next_)));
    now.state = select(leaves, select(unpolarised, next, Real(lane_state::kPolarise)), now.state);
    now.state = select(absorbed, Real(lane_state::kAbsorbed), now.state);
    const Real drawn = select(absorbed, one, Real(3.0)) + select(several, one, zero);
    count_drawn(select(ready, drawn, zero));
  }

  /// As optics::interact_at_reflector, of an opaque sheet that reflects by Lambert's law and specularly.
  void reflect_at_reflector(Now& now, const Mask& here) {
    draw(here, 4.0);
    const Random random = next_numbers();
    const LaneFours<Real> sheet = optics_of(now, 2);
    const Real zero(0.0), one(1.0), share = sheet.of[2];
    const Mask absorbed = random.uniform(0) >= sheet.of[1];
    const Mask mixed = share > zero, specular = mixed & (random.uniform(1) < share);
    const Vector against = -now.normal;
    const Vector diffuse =
        core::lambertian<Real>(against, core::uniform_of<Real>(choose(mixed, random.bits[2], random.bits[1])),
                               core::uniform_of<Real>(choose(mixed, random.bits[3], random.bits[2])));
    const Light mirrored = optics::reflected(now.light, against);
    const Mask unpolarised = is_zero(now.light.polarisation), kept = here & !absorbed;
    now.light = select(kept, select(specular, mirrored, Light{diffuse, now.light.polarisation}), now.light);
    const Real back =
        select(now.kind == Real(lane_state::kReflector), Real(lane_state::kReflected), now.kind);
    store(next_, select(here, back, load(next_)));
    const Real next = select(specular | unpolarised, back, Real(lane_state::kPolarise));
    now.state = select(here, select(absorbed, Real(lane_state::kAbsorbed), next), now.state);
    const Real drawn = one + one_if(mixed) + select(specular, zero, Real(2.0));
    count_drawn(select(here, select(absorbed, one, drawn), zero));
  }

  /// As core::sample_polarisation, of which at most two points are drawn.
  void polarise(Now& now, const Mask& here) {
    draw(here, 2.0);
    const Random random = next_numbers();
    const Mask first = core::CirclePoint<Real>(random.bits[0]).accepted;
    const core::CirclePoint<Real> point(choose(first, random.bits[0], random.bits[1]));
    const Mask done = here & point.accepted;
    now.light.polarisation =
        select(done, core::across_at<Real>(now.light.direction, point), now.light.polarisation);
    now.state = select(done, load(next_), now.state);
    count_drawn(select(here, select(first, Real(1.0), Real(2.0)), Real(0.0)));
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
