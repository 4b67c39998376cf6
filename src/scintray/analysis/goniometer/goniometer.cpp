#include "scintray/analysis/goniometer/goniometer.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "scintray/core/activity.hpp"
#include "scintray/core/cancelled.hpp"
#include "scintray/core/error.hpp"

namespace scintray::analysis {

namespace {

/// Rays of one block; with the order of the sums, it makes readings reproducible.
constexpr std::uint64_t kBlockRays = 16384;

/// Sums of directions on one side, components forward (in the plane of incidence), perpendicular to it, and
/// along the normal.
struct DirectionSums {
  std::uint64_t rays = 0;
  core::Vec3 first = core::Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add(const core::Vec3& d) {
    ++rays;
    first += d;
    second += d * d.transpose();
  }
  void merge(const DirectionSums& other) {
    rays += other.rays;
    first += other.first;
    second += other.second;
  }
};

struct SideTally {
  DirectionCounts counts;
  DirectionSums sums;

  void add(const core::Vec3& d, double sin_half_width) {
    counts.add(d.x(), d.y(), d.z(), sin_half_width);
    sums.add(d);
  }
  void merge(const SideTally& other) {
    counts.merge(other.counts);
    sums.merge(other.sums);
  }
};

struct Tally {
  SideTally reflected, transmitted;
  std::uint64_t absorbed = 0;
};

Lobe lobe_of(const DirectionSums& sums) {
  Lobe lobe;
  lobe.rays = sums.rays;
  if (sums.rays == 0) return lobe;
  const auto n = static_cast<double>(sums.rays);
  const core::Vec3 mean = sums.first / n;
  const double length = mean.norm();
  const core::Vec3 axis = mean / length;
  lobe.in_plane_rad.value = std::atan2(mean.x(), mean.z());
  lobe.across_rad.value = std::asin(axis.y());
  const core::Vec3 in_plane(std::cos(lobe.in_plane_rad.value), 0.0, -std::sin(lobe.in_plane_rad.value));
  const core::Vec3 across = axis.cross(in_plane);
  const auto rms = [&](const core::Vec3& t) { return std::sqrt(std::max(0.0, t.dot(sums.second * t) / n)); };
  lobe.width_in_plane = rms(in_plane);
  lobe.width_across = rms(across);
  lobe.in_plane_rad.error = lobe.width_in_plane / (length * std::sqrt(n));
  lobe.across_rad.error = lobe.width_across / (length * std::sqrt(n));
  return lobe;
}

void check(const GoniometerSettings& s) {
  core::Problems problems;
  if (!(s.incidence_rad >= 0.0 && s.incidence_rad < 0.5 * core::kPi))
    problems.add({},
                 fmt::format("an incidence angle of {:g} deg; expected at least 0 and less than 90 deg",
                             s.incidence_rad / core::kDegree),
                 "angles are from the surface's normal: at 90 deg light passes along the surface and never "
                 "reaches it");
  if (s.rays == 0) problems.add({}, "0 rays; expected at least 1", "a million give errors of 0.0005 or less");
  if (!(s.wavelength_nm > 0.0))
    problems.add({}, fmt::format("a wavelength of {:g} nm; expected more than 0", s.wavelength_nm), "");
  if (!(s.profile_half_width_rad > 0.0 && s.profile_half_width_rad <= 0.5 * core::kPi))
    problems.add(
        {},
        fmt::format("a half-width of the profile of {:g} deg; expected more than 0 and at most 90 deg",
                    s.profile_half_width_rad / core::kDegree),
        "the half-width is the detector's, out of the plane of incidence");
  problems.throw_if_any();
}

}  // namespace

GoniometerReading read_goniometer(const optics::Surface& surface, const optics::IndexPair& index,
                                  const GoniometerSettings& settings) {
  check(settings);
  const core::Vec3 normal = core::Vec3::UnitZ();
  const double into = settings.side == optics::Side::inside ? 1.0 : -1.0;
  const core::Vec3 beam(std::sin(settings.incidence_rad), 0.0, into * std::cos(settings.incidence_rad));
  const double sin_half_width = std::sin(settings.profile_half_width_rad);

  const auto shoot = [&](std::uint64_t number, Tally& tally) {
    core::Rng rng(settings.seed, core::StreamKind::other, number, settings.stream);
    optics::Ray ray{beam, core::Vec3::Zero()};
    const optics::SurfaceOutcome outcome =
        surface.interact(ray, settings.side, normal, index, settings.wavelength_nm, rng);
    if (outcome == optics::SurfaceOutcome::absorbed) {
      ++tally.absorbed;
      return;
    }
    const bool back = outcome == optics::outcome_on(settings.side);
    const double outwards = outcome == optics::SurfaceOutcome::outside ? 1.0 : -1.0;
    const core::Vec3 seen(ray.direction.x(), ray.direction.y(), outwards * ray.direction.z());
    (back ? tally.reflected : tally.transmitted).add(seen, sin_half_width);
  };
  const Tally total = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::uint64_t>(0, settings.rays, kBlockRays), Tally{},
      [&](const tbb::blocked_range<std::uint64_t>& block, Tally tally) {
        if (settings.stop && settings.stop())
          throw core::Cancelled("the goniometer requires all its rays, so nothing was written");
        for (std::uint64_t number = block.begin(); number < block.end(); ++number) shoot(number, tally);
        return tally;
      },
      [](Tally a, const Tally& b) {
        a.reflected.merge(b.reflected);
        a.transmitted.merge(b.transmitted);
        a.absorbed += b.absorbed;
        return a;
      });

  GoniometerReading reading;
  reading.settings = settings;
  reading.settings.stop = {};
  reading.reflected = total.reflected.sums.rays;
  reading.transmitted = total.transmitted.sums.rays;
  reading.absorbed = total.absorbed;
  reading.reflected_directions = total.reflected.counts;
  reading.transmitted_directions = total.transmitted.counts;
  reading.reflected_lobe = lobe_of(total.reflected.sums);
  reading.transmitted_lobe = lobe_of(total.transmitted.sums);
  return reading;
}

std::vector<GoniometerReading> sweep_incidence(const optics::Surface& surface, const optics::IndexPair& index,
                                               GoniometerSettings settings,
                                               const std::vector<double>& incidence_rad) {
  std::vector<GoniometerReading> readings;
  const std::uint64_t first = settings.stream;
  for (std::size_t k = 0; k < incidence_rad.size(); ++k) {
    core::report_activity("measuring angles", k, incidence_rad.size());
    settings.incidence_rad = incidence_rad[k];
    settings.stream = first + k;
    readings.push_back(read_goniometer(surface, index, settings));
  }
  return readings;
}

}  // namespace scintray::analysis
