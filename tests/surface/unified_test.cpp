#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/facets.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

/// Mean visible facet angle at normal incidence, from the direction of mirror reflections at a facet that
/// reflects all light (a huge index step makes the reflectance nearly 1 there).
Estimate mean_facet_angle(const FacetSurface& surface) {
  Moments angle;
  for (std::uint64_t i = 0; i < 300'000; ++i) {
    Rng rng(1, StreamKind::other, i);
    Ray ray{Vec3::UnitZ(), Vec3::Zero()};
    const Side side = surface.scatter(ray, Side::inside, Vec3::UnitZ(), {1.0, 1e9}, rng);
    if (side != Side::inside) continue;
    const double turned = std::acos(std::clamp(-ray.direction.z(), -1.0, 1.0));
    angle.add(0.5 * turned);
  }
  return angle.mean();
}

/// Mean of alpha under a density, by Simpson's rule, below the 45 deg at which a facet sends normal
/// incidence back into the surface.
template <typename Density>
double mean_below_45(Density density) {
  constexpr int kPanels = 20'000;
  const double h = 0.25 * kPi / (2 * kPanels);
  double moment = 0.0, norm = 0.0;
  for (int i = 0; i <= 2 * kPanels; ++i) {
    const double weight = i == 0 || i == 2 * kPanels ? 1.0 : (i % 2 ? 4.0 : 2.0), alpha = i * h;
    moment += weight * alpha * density(alpha);
    norm += weight * density(alpha);
  }
  return moment / norm;
}

}  // namespace

TEST_CASE("The two definitions of sigma_alpha have their own mean facet angles") {
  // Over all angles the means for 18 deg are 22.2 deg and 14.4 deg; single reflections show facets
  // below 45 deg, for which 12 deg leaves nearly all.
  FacetSurface surface;
  surface.sampling = FacetSampling::geant4;
  surface.sigma_alpha_rad = 9.0 * kDegree;
  const double sigma = surface.sigma_alpha_rad;
  const auto gauss = [&](double a) { return std::exp(-0.5 * a * a / (sigma * sigma)); };

  surface.definition = SigmaAlphaDefinition::solid_angle;
  const double solid = mean_below_45([&](double a) { return gauss(a) * std::sin(a); });
  CHECK(sigmas(mean_facet_angle(surface), {solid, 0.0}) < kSigmas);

  surface.definition = SigmaAlphaDefinition::polar_angle;
  const double polar = mean_below_45(gauss);
  CHECK(sigmas(mean_facet_angle(surface), {polar, 0.0}) < kSigmas);
  CHECK(polar < 0.7 * solid);
}

TEST_CASE("Without roughness UNIFIED is the smooth surface") {
  FacetSurface surface;
  surface.sigma_alpha_rad = 0.0;
  constexpr std::uint64_t kRays = 100'000;
  std::uint64_t reflected = 0;
  const double angle = 25.0 * kDegree;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(2, StreamKind::other, i);
    Ray ray{Vec3(std::sin(angle), 0.0, std::cos(angle)), Vec3::Zero()};
    const Side side = surface.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng);
    reflected += side == Side::inside;
    const double sine = side == Side::inside ? std::sin(angle) : 1.82 * std::sin(angle);
    REQUIRE(ray.direction.x() == doctest::Approx(sine).epsilon(1e-12));
  }
  CHECK(sigmas(binomial_estimate(reflected, kRays),
               {fresnel(std::cos(angle), 1.82, 1.0).unpolarised(), 0.0}) < kSigmas);
}

TEST_CASE("Spike, lobe, backscatter and Lambertian shares are those of the settings") {
  FacetSurface surface;
  surface.sigma_alpha_rad = 5.0 * kDegree;
  surface.spike = 0.3;
  surface.lobe = 0.2;
  surface.backscatter = 0.1;
  const double angle = 60.0 * kDegree;  // total reflection at every facet
  const Vec3 k(std::sin(angle), 0.0, std::cos(angle));
  std::uint64_t spike = 0, back = 0;
  constexpr std::uint64_t kRays = 200'000;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(3, StreamKind::other, i);
    Ray ray{k, Vec3::Zero()};
    REQUIRE(surface.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng) == Side::inside);
    spike += (ray.direction - mirror(k, Vec3::UnitZ())).norm() < 1e-9;
    back += (ray.direction + k).norm() < 1e-9;
  }
  CHECK(sigmas(binomial_estimate(spike, kRays), {0.3, 0.0}) < kSigmas);
  CHECK(sigmas(binomial_estimate(back, kRays), {0.1, 0.0}) < kSigmas);
}

namespace {

/// Outcome of one ray on UNIFIED facets of a density per solid angle, written another way: facets by
/// rejection from the whole hemisphere, everything in angles to the mean normal +z, unpolarised Fresnel
/// equations by impedances.
struct Sampled {
  Vec3 direction;  ///< away from the surface, +z back into the medium of incidence
  bool back = false, spike = false;
};

Sampled independent_unified(Vec3 d, double sigma, double n1, double n2, const std::array<double, 3>& shares,
                            Rng& rng) {
  const auto uniform = [&] { return rng.uniform(); };
  double here = n1, there = n2;
  double up = 1.0;  // the surface's normal on the side of the ray is up z
  for (;;) {
    Vec3 m;
    for (;;) {
      const double c = uniform(), phi = kTwoPi * uniform(), s = std::sqrt(1.0 - c * c);
      const double alpha = std::acos(c);
      if (uniform() > std::exp(-0.5 * alpha * alpha / (sigma * sigma))) continue;
      m = Vec3(s * std::cos(phi), s * std::sin(phi), up * c);
      if (d.dot(m) < 0.0) break;
    }
    const double ci = -d.dot(m), sin2t = here * here / (there * there) * (1.0 - ci * ci);
    double reflectance = 1.0;
    if (sin2t < 1.0) {
      const double ct = std::sqrt(1.0 - sin2t);
      const double rs = (here * ci - there * ct) / (here * ci + there * ct);
      const double rp = (there * ci - here * ct) / (there * ci + here * ct);
      reflectance = 0.5 * (rs * rs + rp * rp);
    }
    Sampled out;
    if (uniform() < reflectance) {
      const double u = uniform();
      if (u < shares[0]) {
        d.z() = -d.z();
        out.spike = true;
      } else if (u < shares[0] + shares[1]) {
        d += 2.0 * ci * m;
      } else if (u < shares[0] + shares[1] + shares[2]) {
        d = -d;
      } else {
        const double sin2 = uniform(), phi = kTwoPi * uniform();
        d = Vec3(std::sqrt(sin2) * std::cos(phi), std::sqrt(sin2) * std::sin(phi),
                 up * std::sqrt(1.0 - sin2));
      }
    } else {
      d = (here / there) * d + (here / there * ci - std::sqrt(1.0 - sin2t)) * m;
      std::swap(here, there);
      up = -up;
    }
    if (d.z() * up > 0.0) {
      out.direction = d;
      out.back = up > 0.0;
      return out;
    }
  }
}

}  // namespace

TEST_CASE("Law of UNIFIED's shares: reflectance and directions are those of an independent sampler") {
  // At 40 deg from 1.82 to 1: spike 0.2, lobe 0.3, backscatter 0.1, the rest Lambertian; and lobe alone.
  constexpr std::uint64_t kRays = 300'000;
  constexpr std::size_t kPolar = 12, kAround = 8;
  const double angle = 40.0 * kDegree;
  for (const std::array<double, 3>& shares :
       {std::array{0.2, 0.3, 0.1}, std::array{0.0, 1.0, 0.0}, std::array{0.1, 0.0, 0.6}}) {
    CAPTURE(shares[0]);
    FacetSurface surface;
    surface.sigma_alpha_rad = 12.0 * kDegree;
    surface.sampling = FacetSampling::geant4;
    surface.spike = shares[0];
    surface.lobe = shares[1];
    surface.backscatter = shares[2];
    const Vec3 k(std::sin(angle), 0.0, std::cos(angle));
    // Light that keeps the incident direction or its mirror image is one bin each: it has no width that a
    // histogram could share out, and on the edge of two bins rounding would decide.
    std::vector<std::uint64_t> ours(kPolar * kAround + 2, 0), theirs = ours;
    std::uint64_t back = 0, back_theirs = 0;
    const auto add = [&](const Vec3& d, std::vector<std::uint64_t>& counts) {  // d with +z out of the surface
      if ((d - Vec3(k.x(), 0.0, k.z())).norm() < 1e-9) {
        ++counts[kPolar * kAround];
      } else if ((d - Vec3(-k.x(), 0.0, k.z())).norm() < 1e-9) {
        ++counts[kPolar * kAround + 1];
      } else {
        const double sin2 = std::clamp(1.0 - d.z() * d.z(), 0.0, 1.0);
        const double turn = std::abs(std::atan2(d.y(), d.x())) / kPi;
        ++counts[std::min(kPolar - 1, static_cast<std::size_t>(sin2 * kPolar)) * kAround +
                 std::min(kAround - 1, static_cast<std::size_t>(turn * kAround))];
      }
    };
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(11, StreamKind::other, i), other(12, StreamKind::other, i);
      Ray ray{k, Vec3::Zero()};
      if (surface.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng) == Side::inside) {
        ++back;
        add(Vec3(ray.direction.x(), ray.direction.y(), -ray.direction.z()), ours);
      }
      const Sampled sampled =
          independent_unified(Vec3(k.x(), k.y(), -k.z()), surface.sigma_alpha_rad, 1.82, 1.0, shares, other);
      if (sampled.back) {
        ++back_theirs;
        add(sampled.direction, theirs);
      }
    }
    CHECK(sigmas(binomial_estimate(back, kRays), binomial_estimate(back_theirs, kRays)) < kSigmas);
    // False alarm once in 10,000.
    CHECK(chi_square_two_samples(ours, theirs).p_value > 1e-4);
  }
}

TEST_CASE("Facets by projected area tilt towards the light more than facets of equal weight") {
  FacetSurface surface;
  surface.sigma_alpha_rad = 10.0 * kDegree;
  const double angle = 80.0 * kDegree;
  const auto mean_exit = [&](FacetSampling sampling) {
    surface.sampling = sampling;
    Moments polar;
    for (std::uint64_t i = 0; i < 100'000; ++i) {
      Rng rng(4, StreamKind::other, i);
      Ray ray{Vec3(std::sin(angle), 0.0, std::cos(angle)), Vec3::Zero()};
      if (surface.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng) == Side::inside)
        polar.add(std::acos(-ray.direction.z()));
    }
    return polar.mean();
  };
  const Estimate seen = mean_exit(FacetSampling::projected_area), equal = mean_exit(FacetSampling::geant4);
  CHECK(seen.value < equal.value - kSigmas * std::hypot(seen.error, equal.error));
}
