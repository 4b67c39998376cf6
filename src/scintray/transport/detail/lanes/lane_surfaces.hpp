#pragma once
/// Photons of the pool in lanes: the stages in which they interact with the surface of a face.

#include "scintray/core/sampling_laws.hpp"
#include "scintray/optics/facet_laws.hpp"
#include "scintray/transport/detail/lanes/lane_photons.hpp"
#include "scintray/transport/detail/lanes/lane_refraction.hpp"

namespace scintray::transport {
namespace {

template <typename Real, bool kOneWavelength>
class LaneSurfaces : protected LanePhotons<Real, kOneWavelength> {
  using Photons = LanePhotons<Real, kOneWavelength>;

 protected:
  using Photons::face_of;
  using Photons::go_on_from;
  using Photons::index_;
  using Photons::kWidth;
  using Photons::load;
  using Photons::next_;
  using Photons::number_of_lanes;
  using Photons::one_of;
  using Photons::optics_of;
  using Photons::store;
  using Photons::stream;
  using typename Photons::Bits;
  using typename Photons::Light;
  using typename Photons::Mask;
  using typename Photons::Now;
  using typename Photons::Stream;
  using typename Photons::Vector;
  /// Facets are redrawn until at most this number of lanes lacks one; those wait for the next pass.
  static constexpr int kFewLanes = static_cast<int>(kWidth / 4);

  explicit LaneSurfaces(LanePool& pool) : Photons(pool) {}

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
        Stream random = stream();
        const optics::FacetDraw<Real> facet(numbers, now.light.direction, against,
                                            optics::FacetRandom<Real>(random));
        go_on_from(random, pending);
        m = select(pending & facet.accepted, facet.normal, m);
        pending = pending & !facet.accepted;
      } while (number_of_lanes(pending) > kFewLanes);
    }
    const Mask ready = smooth | (facets & !pending);
    Stream random = stream();
    const Bits for_fresnel = random.next();
    const Mask inside = now.side > Real(0.0);
    const Real index = load(index_);
    const RefractedIn<Real> after = refract(now.light, m, select(inside, index, now.index_behind),
                                            select(inside, now.index_behind, index), for_fresnel);
    now.light = select(ready, after.light, now.light);
    now.side = select(ready & after.transmitted, -now.side, now.side);
    const Real outward = now.side * dot(now.light.direction, now.normal);
    const Mask left = ready & (smooth | (outward < Real(0.0)));
    const Real through =
        select(now.reflector > Real(0.0), Real(lane_state::kReflector), Real(lane_state::kThrough));
    const Real next = select(now.side > Real(0.0), Real(lane_state::kReflected), through);
    now.state = select(left, next, now.state);
    go_on_from(random, ready & after.drawn);
  }

  /// Table and interval for each photon.
  struct LookedUp {
    const optics::TableView* view[kWidth];
    const optics::TableInterval* interval[kWidth];
  };
  LookedUp look_up(const Now& now, const Mask& here, const Real& slants, const Mask& next_slice) const {
    static constexpr optics::TableInterval kNone{};
    LookedUp found;
    alignas(64) double slant[kWidth];
    alignas(64) std::uint64_t step[kWidth], view[kWidth];
    slants.store(slant);
    core::whole_bits_of(optics::lookup_step(slants)).store(step);
    core::whole_bits_of(where(next_slice, Real(2.0)) + where(now.side < Real(0.0), Real(1.0))).store(view);
    const unsigned lanes = lanes_of(here);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      found.interval[lane] = &kNone;
      if ((lanes >> lane & 1) == 0) continue;
      const LaneFaceOptics& face = kOneWavelength
                                       ? face_of(now, lane).at_one
                                       : *reinterpret_cast<const LaneFaceOptics*>(now.optics[lane]);
      found.view[lane] = face.table->view + static_cast<std::uint32_t>(view[lane]);
      found.interval[lane] =
          &optics::interval_at(*found.view[lane], slant[lane], static_cast<std::uint32_t>(step[lane]));
    }
    return found;
  }

  /// Levels among the quantiles of a table, and the interval's first row of these.
  struct Levels {
    optics::TableBin<Real> polar, azimuth;
    Real first_row;
  };
  /// Directions of exit, polar angle and azimuth.
  struct Exits {
    Real polar, azimuth;
  };
  static Exits exits_of(const LookedUp& found, const Mask& leaves, const Mask& reflected, const Real& share,
                        const Levels& at) {
    static constexpr float kNoPolar[4] = {};
    static constexpr std::uint16_t kNoAzimuth[4] = {};
    alignas(64) std::uint64_t row[kWidth], cell[kWidth];
    const Real rows = at.first_row + at.polar.number;
    core::whole_bits_of(rows).store(row);
    core::whole_bits_of(rows * Real(optics::kAzimuthEdges) + at.azimuth.number).store(cell);
    const unsigned lanes = lanes_of(leaves), ways = lanes_of(reflected);
    const float* polar[kWidth];
    const std::uint16_t* azimuth[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      polar[lane] = kNoPolar, azimuth[lane] = kNoAzimuth;
      if ((lanes >> lane & 1) == 0) continue;
      const unsigned way = ways >> lane & 1;
      polar[lane] = found.view[lane]->polar[way] + 2 * static_cast<std::uint32_t>(row[lane]);
      azimuth[lane] = found.view[lane]->azimuth[way] + 2 * static_cast<std::uint32_t>(cell[lane]);
    }
    LaneFours<Real> polars;
    load_four_floats(polar, polars);
    Bits codes;
    load_four_shorts(azimuth, codes);
    const optics::TableQuantiles<Real> of_polar{{polars.of[0], polars.of[1]}, {polars.of[2], polars.of[3]}};
    return {
        of_polar.at(at.polar.part, share),
        Real(optics::azimuth_step_rad(true)) * optics::azimuth_codes<Real>(codes).at(at.azimuth.part, share)};
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
      Stream random = stream();
      const core::CirclePoint<Real> point(random.next());
      go_on_from(random, no_plane);
      forward = select(no_plane, core::across_at<Real>(now.normal, point), forward);
      ready = here & !(no_plane & !point.accepted);
    }
    Stream random = stream();
    const Real for_slice = core::uniform_of<Real>(random.next()), u = core::uniform_of<Real>(random.next());
    const Real for_polar = core::uniform_of<Real>(random.next());
    const Bits azimuth_bits = random.next();
    go_on_from(random, ready);
    const Real slant = optics::slant_of<Real>(sine, magnitude(cosine));
    const LookedUp found = look_up(now, ready, slant, for_slice < optics_of(now, 1).of[0]);
    const double* numbers[kWidth];
    LaneFours<Real> first, second;
    for (std::size_t lane = 0; lane < kWidth; ++lane) numbers[lane] = &found.interval[lane]->start;
    load_fours(numbers, first);
    for (std::size_t lane = 0; lane < kWidth; ++lane) numbers[lane] = &found.interval[lane]->reflectance_step;
    load_fours(numbers, second);
    const Real share = optics::share_of<Real>(slant, first.of[0], first.of[1], first.of[2]);
    const Real reflectance = first.of[3] + share * second.of[0];
    const Real absorptance = second.of[1] + share * second.of[2];

    const Mask reflected = u < reflectance;
    const Mask absorbed = ready & !reflected & (u < reflectance + absorptance);
    const Mask leaves = ready & !absorbed;
    const Levels levels{
        {optics::level_of_two_tails<Real>(for_polar), optics::kPolarBins},
        {optics::level_of_one_tail<Real>(core::uniform_of<Real>(azimuth_bits)), optics::kAzimuthBins},
        second.of[3]};
    const Exits exits = exits_of(found, leaves, reflected, share, levels);
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
  }

  /// As optics::interact_at_reflector, of an opaque sheet that reflects by Lambert's law and specularly.
  void reflect_at_reflector(Now& now, const Mask& here) {
    Stream random = stream();
    const Real u = core::uniform_of<Real>(random.next());
    const Stream behind_first = random;
    const LaneFours<Real> sheet = optics_of(now, 2);
    const Mask absorbed = u >= sheet.of[1], specular = u < sheet.of[1] * sheet.of[2];
    const Vector against = -now.normal;
    const Mask unpolarised = is_zero(now.light.polarisation), kept = here & !absorbed;
    const Light mirrored = optics::reflected(now.light, against);
    if (const Mask scattered = kept & !specular; any(scattered)) {
      const Real sine2 = core::uniform_of<Real>(random.next());
      const Vector diffuse = core::lambertian<Real>(against, sine2, core::uniform_of<Real>(random.next()));
      now.light.direction = select(scattered, diffuse, now.light.direction);
      go_on_from(random, scattered);
    }
    go_on_from(behind_first, here & specular);
    now.light = select(kept & specular, mirrored, now.light);
    const Real back =
        select(now.kind == Real(lane_state::kReflector), Real(lane_state::kReflected), now.kind);
    store(next_, select(here, back, load(next_)));
    const Real next = select(specular | unpolarised, back, Real(lane_state::kPolarise));
    now.state = select(here, select(absorbed, Real(lane_state::kAbsorbed), next), now.state);
  }

  /// As core::sample_polarisation, of which at most two points are drawn.
  void polarise(Now& now, const Mask& here) {
    Stream random = stream();
    const Bits first_bits = random.next();
    const Mask first = core::CirclePoint<Real>(first_bits).accepted;
    const Stream behind_first = random;
    const core::CirclePoint<Real> point(
        bits_of(select(first, number_of(first_bits), number_of(random.next()))));
    go_on_from(select<Real>(first, behind_first, random), here);
    const Mask done = here & point.accepted;
    now.light.polarisation =
        select(done, core::across_at<Real>(now.light.direction, point), now.light.polarisation);
    now.state = select(done, load(next_), now.state);
  }
};

}  // namespace
}  // namespace scintray::transport
