#pragma once
/// The kernel of lane_pool.hpp for one instruction set. Included by one file for each.
///
/// A pass carries each photon of one vector from where it waits (lane_state) as far as the order of the stages
/// allows: microsurface, reflector, polarisation, propagation to the next plane. A stage without photons is left
/// out; photons that are not in it are masked. The stages have no branches on single photons, so that vectors,
/// which are independent, overlap in the processor: each photon is one long chain of operations.

#include <limits>

#include "scintray/core/sampling_laws.hpp"
#include "scintray/optics/facet_laws.hpp"
#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/optics/table_view.hpp"
#include "scintray/transport/detail/lanes/lane_memory.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"

namespace scintray::transport {
namespace {

template <typename Arch>
class LanePasses {
  using Real = LaneReal<Arch>;
  using Mask = LaneMask<Arch>;
  using Bits = LaneBits<Arch>;
  using Vector = core::Triple<Real>;
  using Light = optics::LightRay<Real>;
  static constexpr std::size_t kWidth = Real::kWidth;
  static_assert(LanePool::kPhotons % kWidth == 0);

 public:
  explicit LanePasses(LanePool& pool) : pool_(pool) {}

  void run() {
    for (bool some_wait = false; !some_wait;)
      for (at_ = 0; at_ < LanePool::kPhotons; at_ += kWidth) some_wait = pass() || some_wait;
  }

 private:
  /// Random numbers that a pass draws at most for a photon: at a microsurface, at a reflector behind it, and
  /// for a polarisation.
  static constexpr double kMostDrawn = 4.0 + 4.0 + 2.0;

  /// What stages change, and the plane that a photon is at.
  struct Now {
    Real state, side;
    Light light;
    Vector normal;  ///< of the plane, out of the region
    Real kind, index_behind, least_sin2, counted, reflector;
    const double* face[kWidth];  ///< LaneFace
  };

  Real load(const LanePool::Numbers& numbers) const { return Real::Lanes::load_aligned(numbers + at_); }
  Vector load(const LanePool::Numbers (&numbers)[3]) const {
    return {load(numbers[0]), load(numbers[1]), load(numbers[2])};
  }
  Bits load(const LanePool::Counts& counts) const { return Bits::Lanes::load_aligned(counts + at_); }
  void store(LanePool::Numbers& to, const Real& value) const { value.lanes.store_aligned(to + at_); }
  void store(LanePool::Numbers (&to)[3], const Vector& value) const {
    store(to[0], value.x), store(to[1], value.y), store(to[2], value.z);
  }
  void store(LanePool::Counts& to, const Bits& value) const { value.lanes.store_aligned(to + at_); }

  /// One pass of the photons at `at_`; true when one of them waits then.
  [[gnu::flatten]] bool pass() {
    Now now;
    now.state = load(pool_.state);
    const Mask begins = (now.state > Real(lane_state::kEmpty)) & (now.state < Real(lane_state::kFirstWaiting));
    if (!any(begins)) return any(now.state >= Real(lane_state::kFirstWaiting));
    now.light = {load(pool_.direction), load(pool_.polarisation)};
    now.side = load(pool_.side);
    const auto in = [&now](double state) { return now.state == Real(state); };
    if (any(begins & !in(lane_state::kPropagate))) interact(now);
    // Between total reflections nothing is drawn.
    for (Mask here = in(lane_state::kPropagate); any(here);) {
      propagate(now, here);
      here = in(lane_state::kPropagate);
      if (!all(here)) break;
    }
    // Long before they are loaded, as a processor waits where what is loaded was stored in parts a moment ago.
    draw_ahead(now.state);
    store(pool_.state, now.state);
    store(pool_.side, now.side);
    store(pool_.direction, now.light.direction);
    store(pool_.polarisation, now.light.polarisation);
    return any(now.state >= Real(lane_state::kFirstWaiting));
  }

  /// The stages at a surface.
  void interact(Now& now) {
    draw_ahead(now.state);  // of photons that have just entered
    load_faces(now);
    const auto in = [&now](double state) { return now.state == Real(state); };
    const Mask smooth = in(lane_state::kSmooth), facets = in(lane_state::kFacets);
    if (any(smooth | facets)) pass_microsurface(now, smooth, facets);
    if (const Mask here = in(lane_state::kTable); any(here)) pass_table(now, here);
    if (const Mask here = in(lane_state::kReflector); any(here)) reflect_at_reflector(now, here);
    if (const Mask here = in(lane_state::kPolarise); any(here)) polarise(now, here);
    if (const Mask here = in(lane_state::kReflected); any(here)) {
      const Mask within = (load(pool_.interactions) < Real(pool_.most_interactions)) &
                          (load(pool_.time_ns) <= Real(pool_.most_time_ns));
      now.state = select(here, select(within, Real(lane_state::kPropagate), Real(lane_state::kCut)), now.state);
    }
  }

  // Random numbers.

  /// Blocks of random numbers, until each photon has enough for its next pass.
  void draw_ahead(const Real& state) {
    const Mask draws = (state > Real(lane_state::kEmpty)) & (state < Real(lane_state::kFirstWaiting));
    for (;;) {
      const Bits blocks = load(pool_.counter[0]);
      const Real ready = value_of((blocks << 2) - load(pool_.drawn));
      if (!any(draws & (ready < Real(kMostDrawn)))) return;
      using Block = core::PhiloxBlock<Bits>;
      const Block block({blocks, load(pool_.counter[1]), load(pool_.counter[2]), load(pool_.counter[3])},
                        {load(pool_.key[0]), load(pool_.key[1])});
      const Real taken = one_if(ready <= Real(static_cast<double>(LanePool::kNumbers - 4)));
      const Bits takes = whole(taken);
      store(pool_.counter[0], blocks + takes);
      alignas(64) std::uint64_t number[kWidth], take[kWidth];
      blocks.lanes.store_aligned(number);
      takes.lanes.store_aligned(take);
      std::uint64_t *first[kWidth], *second[kWidth], nowhere[4];
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        std::uint64_t* const numbers = pool_.numbers[at_ + lane];
        const std::uint64_t at = number[lane] * 4 % LanePool::kNumbers;
        first[lane] = take[lane] != 0 ? numbers + at : nowhere;
        second[lane] = take[lane] != 0 && at == 0 ? numbers + LanePool::kNumbers : nowhere;
      }
      store_fours(block.words, first, second);
    }
  }
  /// A whole number from 0 to 7 as bits.
  static Bits whole(const Real& number) { return bits_of(number + Real(0x1.0p52)) & Bits(7); }

  /// The next four random numbers of each photon, not yet counted as drawn.
  struct Random {
    Bits bits[4];
    Real uniform(int i) const { return core::uniform_of<Real>(bits[i]); }
  };
  Random next_numbers() const {
    const double* first[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      first[lane] = reinterpret_cast<const double*>(pool_.numbers[at_ + lane]) +
                    pool_.drawn[at_ + lane] % LanePool::kNumbers;
    LaneFours<Arch> fours;
    load_fours(first, fours);
    return {{bits_of(fours.of[0]), bits_of(fours.of[1]), bits_of(fours.of[2]), bits_of(fours.of[3])}};
  }
  /// Counts numbers as drawn, whole ones from 0 to 7.
  void count_drawn(const Real& numbers) {
    store(pool_.drawn, load(pool_.drawn) + whole(numbers));
  }
  static Real one_if(const Mask& condition) { return select(condition, Real(1.0), Real(0.0)); }
  static Bits choose(const Mask& condition, const Bits& yes, const Bits& no) {
    return bits_of(select(condition, number_of(yes), number_of(no)));
  }

  // Planes and faces.

  void load_faces(Now& now) const {
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      now.face[lane] = reinterpret_cast<const double*>(pool_.region[at_ + lane].faces +
                                                       static_cast<std::size_t>(pool_.plane[at_ + lane]));
    const LaneFours<Arch> first = face_numbers(now, 0), second = face_numbers(now, 1);
    now.normal = {first.of[0], first.of[1], first.of[2]};
    now.kind = first.of[3];
    now.index_behind = second.of[0];
    now.least_sin2 = second.of[1];
    now.counted = second.of[2];
    now.reflector = second.of[3];
  }
  /// Four numbers of LaneFace, the first, second, third or fourth.
  static LaneFours<Arch> face_numbers(const Now& now, int which) {
    const double* at[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) at[lane] = now.face[lane] + 4 * which;
    LaneFours<Arch> fours;
    load_fours(at, fours);
    return fours;
  }

  struct Ahead {
    Real distance_mm, plane;
  };
  /// One or two parallel planes, and the nearest plane so far.
  static void take(Ahead& nearest, const Vector& normal, const Real (&offset_mm)[2], const Vector& local,
                   const Vector& direction, std::size_t i) {
    // The order of additions of scene/detail/nearest_plane.hpp.
    const auto product = [](const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const Real signed_along = product(normal, direction), height = product(normal, local);
    const Mask first = signed_along > Real(0.0);
    const Real along = magnitude(signed_along);
    const Real ahead = select(first, offset_mm[0] - height, offset_mm[1] + height);
    const Real distance = ahead / along;
    const Mask closer = (along > Real(0.0)) & (distance < nearest.distance_mm);
    const Real number = select(first, Real(2.0 * static_cast<double>(i)), Real(2.0 * static_cast<double>(i) + 1.0));
    nearest.distance_mm = select(closer, distance, nearest.distance_mm);
    nearest.plane = select(closer, number, nearest.plane);
  }
  Ahead nearest_plane(const Vector& local, const Vector& direction) const {
    Ahead nearest{Real(std::numeric_limits<double>::infinity()), Real(0.0)};
    const LaneRegion* const regions = pool_.region + at_;
    bool same = true;
    std::size_t count = regions[0].count;
    for (std::size_t lane = 1; lane < kWidth; ++lane) {
      same = same && regions[lane].planes == regions[0].planes;
      count = regions[lane].count > count ? regions[lane].count : count;
    }
    if (same) {
      for (std::size_t i = 0; i < count; ++i) {
        const PlanePair& planes = regions[0].planes[i];
        take(nearest, {Real(planes.normal[0]), Real(planes.normal[1]), Real(planes.normal[2])},
             {Real(planes.first_mm), Real(planes.second_mm)}, local, direction, i);
      }
      return nearest;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double *first[kWidth], *second[kWidth];
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        const LaneRegion& region = regions[lane];  // the last planes again where there are fewer
        const PlanePair& planes = region.planes[i < region.count ? i : region.count - 1];
        first[lane] = planes.normal;
        second[lane] = &planes.second_mm;
      }
      LaneFours<Arch> of_first, of_second;
      load_fours(first, of_first);
      load_fours(second, of_second);
      take(nearest, {of_first.of[0], of_first.of[1], of_first.of[2]}, {of_first.of[3], of_second.of[0]}, local,
           direction, i);
    }
    return nearest;
  }

  // Stages.

  /// To the next plane, and through a total reflection there.
  void propagate(Now& now, const Mask& here) {
    constexpr double kTimePerLength = 1.0 / 299.792458;  // core::kSpeedOfLight_mm_per_ns
    const Vector position = load(pool_.position), direction = now.light.direction;
    const Ahead ahead = nearest_plane(position - load(pool_.centre), direction);
    store(pool_.plane, select(here, ahead.plane, load(pool_.plane)));
    load_faces(now);

    const Real zero(0.0), one(1.0);
    const Real distance = select(ahead.distance_mm < zero, zero, ahead.distance_mm);
    const Real depth = load(pool_.attenuation_per_mm) * distance, depth_left = load(pool_.depth_left);
    const Mask bulk = depth > depth_left, unclear = now.kind == Real(lane_state::kUnclear);
    const Mask moves = here & !(bulk | unclear);
    const Real path = load(pool_.path_mm), time = load(pool_.time_ns);
    const Real there_time = time + distance * load(pool_.group_index) * Real(kTimePerLength);
    store(pool_.position, select(moves, position + distance * direction, position));
    store(pool_.path_mm, select(moves, path + distance, path));
    store(pool_.time_ns, select(moves, there_time, time));
    store(pool_.depth_left, select(moves, depth_left - depth, depth_left));
    store(pool_.segments, load(pool_.segments) + one_if(here & (bulk | !unclear)));
    const Real interactions = load(pool_.interactions) + select(moves, now.counted, zero);
    store(pool_.interactions, interactions);

    const Real cosine = dot(direction, now.normal);
    store(pool_.cos_before, select(here, magnitude(cosine), load(pool_.cos_before)));
    const Mask total = one - cosine * cosine >= now.least_sin2;
    now.light = select(moves & total, reflected(now.light, now.normal), now.light);
    const Mask within =
        (interactions < Real(pool_.most_interactions)) & (there_time <= Real(pool_.most_time_ns));
    const Real after_total = select(within, Real(lane_state::kPropagate), Real(lane_state::kCut));
    const Real stays = select(bulk, Real(lane_state::kBulk), Real(lane_state::kUnclear));
    const Real moved = select(total, after_total, now.kind);
    now.state = select(here, select(moves, moved, stays), now.state);
    now.side = select(here, one, now.side);
  }

  /// Smooth surfaces, and facets, of which one is drawn first; where it is not accepted the photon stays.
  void pass_microsurface(Now& now, const Mask& smooth, const Mask& facets) {
    const Random random = next_numbers();
    const Vector against = -now.side * now.normal;
    Vector m = against;
    Mask ready = smooth;
    Bits for_fresnel = random.bits[0];
    if (any(facets)) {
      const LaneFours<Arch> more = face_numbers(now, 2);
      const optics::FacetTilt<Real> tilt = optics::FacetTilt<Real>::drawn(
          more.of[0], core::uniform_positive_of<Real>(random.bits[0]));
      const Mask by_area = face_numbers(now, 3).of[0] > Real(0.0);
      const optics::WidestFacet<Real> widest{more.of[2], more.of[3]};
      const Real area = widest.greatest_area(-dot(now.light.direction, against));
      const optics::FacetChoice<Real> facet(now.light.direction, against, core::Across<Real>(against), tilt,
                                            by_area, area, core::TwoUniforms<Real>(random.bits[1]));
      m = select(facets, facet.normal, against);
      ready = ready | (facets & facet.accepted & (tilt.angle_rad < more.of[1]));
      for_fresnel = choose(facets, random.bits[2], random.bits[0]);
    }
    const Mask inside = now.side > Real(0.0);
    const Real index = load(pool_.index);
    const Refracted after = refract(now.light, m, select(inside, index, now.index_behind),
                                    select(inside, now.index_behind, index), for_fresnel);
    now.light = select(ready, after.light, now.light);
    now.side = select(ready & after.transmitted, -now.side, now.side);
    const Real outward = now.side * dot(now.light.direction, now.normal);
    const Mask left = ready & (smooth | (outward < Real(0.0)));
    const Real through =
        select(now.reflector > Real(0.0), Real(lane_state::kReflector), Real(lane_state::kCrossed));
    const Real next = select(now.side > Real(0.0), Real(lane_state::kReflected), through);
    now.state = select(left, next, now.state);
    count_drawn(select(facets, Real(2.0), Real(0.0)) + one_if(ready & after.drawn));
  }

  /// As optics::SurfaceTable::interact, of a table of one slice whose azimuths are folded. Nearly along the
  /// normal the plane of incidence is drawn; where that is not accepted the photon stays.
  void pass_table(Now& now, const Mask& here) {
    const Random random = next_numbers();
    const Real owner = face_numbers(now, 3).of[3], zero(0.0), one(1.0);
    const Vector normal = owner * now.normal;
    const Real cosine = dot(now.light.direction, normal);
    const Vector lateral = now.light.direction - cosine * normal;
    const Real sine = root(dot(lateral, lateral));
    const Mask no_plane = !(sine > Real(optics::kNoPlane));
    const core::CirclePoint<Real> point(random.bits[0]);
    const Vector forward =
        select(no_plane, core::across_at<Real>(normal, point),
               Vector{lateral.x / sine, lateral.y / sine, lateral.z / sine});
    const Vector across = cross(normal, forward);
    const Mask found = here & (point.accepted | !no_plane);
    const Bits for_azimuth = choose(no_plane, random.bits[3], random.bits[2]);
    const Real level = optics::level_of_two_tails(
        core::uniform_of<Real>(choose(no_plane, random.bits[2], random.bits[1])));
    const Exits exits = table_exits(now, found,
                                    {optics::slant_of(sine, magnitude(cosine)),
                                     core::uniform_of<Real>(choose(no_plane, random.bits[1], random.bits[0])),
                                     level, optics::level_of_one_tail(core::uniform_of<Real>(for_azimuth)),
                                     for_azimuth});
    const core::SineCosineOf<Real> polar = core::laws::sincos<Real>(exits.polar);
    const core::SineCosineOf<Real> azimuth = core::laws::sincos<Real>(exits.azimuth);
    const Mask grazing = polar.cosine < Real(optics::kLeastCosine);
    const Real sin_polar = select(grazing, one, polar.sine);
    const Real cos_polar = select(grazing, Real(optics::kLeastCosine), polar.cosine);
    const Mask reflected = exits.outcome == Real(kTableReflects);
    const Mask absorbed = found & (exits.outcome == Real(kTableAbsorbs)), leaves = found & !absorbed;
    const Real side = select(reflected, now.side, -now.side), out = -(side * owner);
    const Vector direction = sin_polar * (azimuth.cosine * forward + azimuth.sine * across) +
                             (out * cos_polar) * normal;
    now.light.direction = select(leaves, direction, now.light.direction);
    now.side = select(leaves, side, now.side);
    const Real through =
        select(now.reflector > zero, Real(lane_state::kReflector), Real(lane_state::kCrossed));
    const Real next = select(side > zero, Real(lane_state::kReflected), through);
    store(pool_.next, select(leaves, next, load(pool_.next)));
    const Real left = select(is_zero(now.light.polarisation), next, Real(lane_state::kPolarise));
    now.state = select(found, select(absorbed, Real(lane_state::kAbsorbed), left), now.state);
    const Real drawn = select(absorbed, one, Real(3.0));
    count_drawn(select(here, one_if(no_plane) + select(found, drawn, zero), zero));
  }

  static constexpr double kTableReflects = 1.0, kTableTransmits = 2.0, kTableAbsorbs = 3.0;
  struct Arrivals {
    Real slant, choice;          ///< measure of the incidence; random number that decides where light leaves
    Real polar_level, azimuth_level;
    Bits side;                   ///< the last bit: of the plane of incidence
  };
  struct Exits {
    Real polar, azimuth, outcome;
  };
  /// Directions from tables, whose numbers are read for each photon alone.
  Exits table_exits(const Now& now, const Mask& here, const Arrivals& arrivals) const {
    const Lanes slant(arrivals.slant), choice(arrivals.choice), polar_level(arrivals.polar_level);
    const Lanes azimuth_level(arrivals.azimuth_level), side(now.side), wanted(one_if(here));
    alignas(64) std::uint64_t bits[kWidth];
    arrivals.side.lanes.store_aligned(bits);
    Lanes polar(Real(0.0)), azimuth(Real(0.0)), outcome(Real(0.0));
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      if (wanted.of[lane] == 0.0) continue;
      const auto* const face = reinterpret_cast<const LaneFace*>(now.face[lane]);
      const optics::TableView& table = *face->table[side.of[lane] > 0.0 ? 0 : 1];
      const optics::TablePlace<Real> place(table, slant.of[lane]);
      const double reflectance = place.reflectance();
      const bool reflected = choice.of[lane] < reflectance;
      // Rounding must not transmit light where no node does.
      if (table.absorbs && !reflected &&
          (!place.transmits() || choice.of[lane] < reflectance + place.absorptance())) {
        outcome.of[lane] = kTableAbsorbs;
        continue;
      }
      const optics::TableExit exit = place.exit(table, reflected, polar_level.of[lane],
                                                azimuth_level.of[lane], (bits[lane] & 1) != 0);
      polar.of[lane] = exit.polar;
      azimuth.of[lane] = exit.azimuth;
      outcome.of[lane] = reflected ? kTableReflects : kTableTransmits;
    }
    return {polar.load(), azimuth.load(), outcome.load()};
  }
  /// The numbers of all lanes in memory.
  struct Lanes {
    alignas(64) double of[kWidth];
    explicit Lanes(const Real& numbers) { numbers.lanes.store_aligned(of); }
    Real load() const { return Real::Lanes::load_aligned(of); }
  };

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
    const Vector direction = select(transmitted, select(straight, light.direction, facet.refracted()),
                                    mirrored.direction);
    Vector polarisation = facet.polarised(transmitted, direction);
    polarisation = select(unpolarised | (straight & transmitted), light.polarisation, polarisation);
    polarisation = select(total | (straight & !transmitted), mirrored.polarisation, polarisation);
    return {{direction, polarisation}, transmitted, !total};
  }

  /// As optics::interact_at_reflector, of an opaque sheet that reflects by Lambert's law and specularly.
  void reflect_at_reflector(Now& now, const Mask& here) {
    const Random random = next_numbers();
    const LaneFours<Arch> sheet = face_numbers(now, 3);
    const Real zero(0.0), one(1.0), share = sheet.of[2];
    const Mask absorbed = random.uniform(0) >= sheet.of[1];
    const Mask mixed = share > zero, specular = mixed & (random.uniform(1) < share);
    const Vector against = -now.normal;
    const Vector diffuse = core::lambertian<Real>(
        against, core::uniform_of<Real>(choose(mixed, random.bits[2], random.bits[1])),
        core::uniform_of<Real>(choose(mixed, random.bits[3], random.bits[2])));
    const Light mirrored = optics::reflected(now.light, against);
    const Mask unpolarised = is_zero(now.light.polarisation), kept = here & !absorbed;
    now.light = select(kept, select(specular, mirrored, Light{diffuse, now.light.polarisation}), now.light);
    const Real back = select(now.kind == Real(lane_state::kReflector), Real(lane_state::kReflected), now.kind);
    store(pool_.next, select(here, back, load(pool_.next)));
    const Real next = select(specular | unpolarised, back, Real(lane_state::kPolarise));
    now.state = select(here, select(absorbed, Real(lane_state::kAbsorbed), next), now.state);
    const Real drawn = one + one_if(mixed) + select(specular, zero, Real(2.0));
    count_drawn(select(here, select(absorbed, one, drawn), zero));
  }

  /// As core::sample_polarisation, of which at most two points are drawn.
  void polarise(Now& now, const Mask& here) {
    const Random random = next_numbers();
    const Mask first = core::CirclePoint<Real>(random.bits[0]).accepted;
    const core::CirclePoint<Real> point(choose(first, random.bits[0], random.bits[1]));
    const Mask done = here & point.accepted;
    now.light.polarisation =
        select(done, core::across_at<Real>(now.light.direction, point), now.light.polarisation);
    now.state = select(done, load(pool_.next), now.state);
    count_drawn(select(here, select(first, Real(1.0), Real(2.0)), Real(0.0)));
  }

  LanePool& pool_;
  std::size_t at_ = 0;  ///< the first photon of the vector
};

}  // namespace
}  // namespace scintray::transport
