#include "scintray/trace/flight.hpp"

#include <cmath>

#include "scintray/core/lanes.hpp"

namespace scintray {

namespace {

/// The sum of three vectors times the first three numbers of v, whose fourth number stays.
Lanes combine(Lanes v, Lanes x, Lanes y, Lanes z) {
  return (v.xy[0] * x + v.xy[1] * y + v.zw[0] * z).with_fourth(v.zw[1]);
}
Lanes rotate(const Eigen::Matrix3d& m, Lanes v) {
  return combine(v, {m.col(0), 0.0}, {m.col(1), 0.0}, {m.col(2), 0.0});
}
Lanes rotate_back(const Eigen::Matrix3d& m, Lanes v) {
  return combine(v, {m.row(0).transpose(), 0.0}, {m.row(1).transpose(), 0.0}, {m.row(2).transpose(), 0.0});
}

/// sin^2 of the critical angle towards a medium; above 1 where nothing is totally reflected.
double critical_sin2(const Scene& scene, std::uint32_t medium, const Photon& photon) {
  constexpr double kNever = 2.0;
  if (medium == kNotSmooth || scene.media[medium].is_opaque()) return kNever;
  const double ratio = scene.media[medium].index(photon.wavelength_nm) / photon.optics.index;
  return ratio * ratio;
}

void put_back(Photon& photon, Lanes position, Lanes direction, Lanes polarisation, TwoDoubles path_and_time,
              double depth_left, std::uint64_t interactions) {
  photon.position = position.vec();
  photon.ray.direction = direction.vec();
  photon.ray.polarisation = polarisation.vec();
  photon.path_mm = path_and_time[0];
  photon.time_ns = path_and_time[1];
  photon.optical_depth = depth_left;
  photon.interactions = static_cast<std::uint32_t>(interactions);
}

}  // namespace

Step total_reflection(const Scene& scene, const Photon& photon, std::uint32_t triangle, double cosine) {
  const BoundaryLink& link = scene.regions[photon.region].links[triangle];
  Step step;
  step.kind = StepKind::returned;
  step.from_back = link.from_back;
  step.region = photon.region;
  step.interface = link.interface;
  step.triangle = triangle;
  step.cos_before = step.cos_after = cosine;
  return step;
}

namespace {

// The loop waits for Embree and then for what the next ray needs, so the next ray starts from Embree's own
// hit, in single precision, while the exact one is computed beside it; every piece starts from exact numbers
// again. Nothing in it captures or takes the address of what changes, which would put it into memory.
// tools/bench crystal shows what this is worth.
void fly_on_with_embree(const Scene& scene, Photon& photon, const FlightLimits& limits, Flight& flight) {
  const Region& region = scene.regions[photon.region];
  const Accelerator& accelerator = *region.accelerator;
  const bool rotated = region.rotated;
  const double start_mm = accelerator.start_mm();
  const double attenuation = photon.optics.absorption_per_mm + photon.optics.scattering_per_mm;
  const TwoDoubles rates{1.0, photon.optics.group_index * (1.0 / kSpeedOfLight_mm_per_ns)};
  const Lanes centre(region.centre, 1.0);

  Lanes position(photon.position, 0.0), direction(photon.ray.direction, 0.0);
  Lanes polarisation(photon.ray.polarisation, 0.0);
  TwoDoubles path_and_time{photon.path_mm, photon.time_ns};
  double depth_left = photon.optical_depth;
  std::uint32_t known_medium = kNotSmooth;
  double least_sin2 = critical_sin2(scene, known_medium, photon);

  // In the region's frame, as the accelerator takes them: fourth -1 and 0.
  Lanes local = position - centre, ahead = direction;
  if (rotated) {
    local = rotate_back(region.rotation, local);
    ahead = rotate_back(region.rotation, ahead);
  }
  FourFloats ray_origin = local.with_fourth(start_mm).floats(), ray_direction = ahead.floats();

  FlightEnd end;
  std::uint32_t segments = 0, resolved = 0, triangle;
  double cosine;
  std::uint64_t interactions = photon.interactions;
  for (;;) {
    ++segments;
    const FirstHit hit = accelerator.first_hit(ray_origin, ray_direction);
    Approach approach;
    triangle = hit.triangle;
    if (triangle != kNoTriangle) [[likely]]
      approach = accelerator.approach_of(triangle, local, ahead);
    const bool sure = approach.cosine > 0.0;
    cosine = approach.cosine;
    double distance_mm = approach.distance_mm;
    if (!sure) [[unlikely]] {
      const Exit exit = accelerator.exit_after_doubt(local.vec(), ahead.vec(), hit);
      resolved += exit.resolved ? 1 : 0;
      triangle = exit.triangle;
      if (triangle == kNoTriangle) {
        end = attenuation > 0.0 ? FlightEnd::bulk : FlightEnd::escape;
        break;
      }
      distance_mm = exit.distance_mm;
      cosine = dot(accelerator.plane(triangle), ahead);
    }

    const double depth = attenuation * distance_mm;
    if (depth > depth_left) {
      end = FlightEnd::bulk;
      break;
    }
    depth_left -= depth;
    path_and_time += distance_mm * rates;
    position = position + distance_mm * direction;
    const std::uint32_t medium = region.links[triangle].smooth_to;
    if (medium != known_medium) {
      known_medium = medium;
      least_sin2 = critical_sin2(scene, medium, photon);
    }
    if (!(1.0 - cosine * cosine >= least_sin2)) {
      end = FlightEnd::boundary;
      break;
    }

    ++interactions;  // and from here as reflect()
    Lanes normal = accelerator.plane(triangle).with_fourth(0.0);
    if (rotated) normal = rotate(region.rotation, normal);
    const Lanes twice = normal + normal;
    direction = direction - cosine * twice;
    polarisation = dot(normal, polarisation) * twice - polarisation;
    if (!limits.allow(interactions, path_and_time[1])) {
      end = FlightEnd::total;
      break;
    }
    if (limits.passed) [[unlikely]] {
      put_back(photon, position, direction, polarisation, path_and_time, depth_left, interactions);
      (*limits.passed)(photon, total_reflection(scene, photon, triangle, cosine));
    }

    ray_origin = local.with_fourth(start_mm).floats() + hit.distance_mm * ray_direction;
    local = position - centre;
    ahead = direction;
    if (rotated) {
      local = rotate_back(region.rotation, local);
      ahead = rotate_back(region.rotation, ahead);
    }
    ray_direction = ahead.floats();
    if (!sure) [[unlikely]]
      ray_origin = local.with_fourth(start_mm).floats();
  }

  put_back(photon, position, direction, polarisation, path_and_time, depth_left, interactions);
  flight = {end, triangle, cosine, flight.segments + segments, flight.resolved + resolved};
}

}  // namespace

// What is not Embree's, and the way to the first total reflection, which is all of it on rough faces, is
// better served by the photon as it is.
Flight fly(const Scene& scene, Photon& photon, const FlightLimits& limits) {
  const Region& region = scene.regions[photon.region];
  const double attenuation = photon.optics.absorption_per_mm + photon.optics.scattering_per_mm;
  Flight flight;
  for (;;) {
    ++flight.segments;
    const Exit exit = region.find_exit(photon.position, photon.ray.direction);
    flight.resolved += exit.resolved ? 1 : 0;
    flight.triangle = exit.triangle;
    if (exit.triangle == kNoTriangle) {
      flight.end = attenuation > 0.0 ? FlightEnd::bulk : FlightEnd::escape;
      return flight;
    }
    const double depth = attenuation * exit.distance_mm;
    if (depth > photon.optical_depth) {
      flight.end = FlightEnd::bulk;
      return flight;
    }
    photon.optical_depth -= depth;
    advance(photon, exit.distance_mm);
    flight.end = FlightEnd::boundary;
    const std::uint32_t medium = region.links[exit.triangle].smooth_to;
    if (medium == kNotSmooth) return flight;
    const Vec3 normal = region.direction_to_world(region.accelerator->normal(exit.triangle));
    flight.cosine = photon.ray.direction.dot(normal);
    if (!(1.0 - flight.cosine * flight.cosine >= critical_sin2(scene, medium, photon))) return flight;

    ++photon.interactions;
    reflect(photon.ray, normal);
    flight.end = FlightEnd::total;
    if (!limits.allow(photon.interactions, photon.time_ns)) return flight;
    if (limits.passed)
      (*limits.passed)(photon, total_reflection(scene, photon, exit.triangle, flight.cosine));
    if (region.accelerator->uses_embree()) {
      fly_on_with_embree(scene, photon, limits, flight);
      return flight;
    }
  }
}

}  // namespace scintray
