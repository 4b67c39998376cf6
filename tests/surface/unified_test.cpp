#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/unified.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

/// Mean visible facet angle at normal incidence, from the direction of mirror reflections at a facet that
/// reflects all light (a huge index step makes the reflectance nearly 1 there).
Estimate mean_facet_angle(const UnifiedSurface& surface) {
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
  UnifiedSurface surface;
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
  UnifiedSurface surface;
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
  UnifiedSurface surface;
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

TEST_CASE("Facets by projected area tilt towards the light more than facets of equal weight") {
  UnifiedSurface surface;
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
