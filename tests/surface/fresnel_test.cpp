#include <doctest/doctest.h>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/fresnel.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

const Vec3 kNormal = Vec3(0.36, -0.48, 0.8);  // skew on purpose

Ray incident(double angle, double polarisation_angle) {
  const Frame frame = Frame::about(kNormal);
  Ray ray;
  ray.direction = -std::cos(angle) * kNormal + std::sin(angle) * frame.x;
  // At normal incidence any direction across is as good as another.
  const Vec3 s = angle > 0.0 ? Vec3(ray.direction.cross(kNormal).normalized()) : frame.y;
  const Vec3 p = s.cross(ray.direction.vec());
  ray.polarisation = std::cos(polarisation_angle) * s + std::sin(polarisation_angle) * p;
  return ray;
}

}  // namespace

TEST_CASE("Snell's law and the plane of incidence, both ways through a skew facet") {
  for (const auto& [n1, n2] : {std::pair{1.82, 1.0}, std::pair{1.0, 1.82}, std::pair{1.82, 1.5}}) {
    for (const double degrees : {0.0, 5.0, 20.0, 30.0}) {
      bool transmitted = false;
      for (std::uint64_t i = 0; i < 50 && !transmitted; ++i) {
        Rng rng(1, StreamKind::other, i);
        Ray ray = incident(degrees * kDegree, 0.3);
        const Vec3 before = ray.direction;
        transmitted = interact_at_facet(ray, kNormal, n1, n2, rng);
        if (!transmitted) continue;
        const double sine = ray.direction.cross(kNormal).norm();
        CHECK(n2 * sine == doctest::Approx(n1 * std::sin(degrees * kDegree)).epsilon(1e-12));
        CHECK(std::abs(ray.direction.dot(before.cross(kNormal))) < 1e-12);
        CHECK(ray.direction.dot(kNormal) < 0.0);
        CHECK(std::abs(ray.polarisation.dot(ray.direction)) < 1e-12);
        CHECK(ray.polarisation.norm() == doctest::Approx(1.0).epsilon(1e-12));
      }
      CHECK(transmitted);
    }
  }
}

TEST_CASE("Reflectance of s, p, mixed and unpolarised light is Fresnel's") {
  constexpr std::uint64_t kRays = 200'000;
  for (const double degrees : {0.0, 15.0, 28.7866, 33.0}) {
    const FresnelCoefficients expected = fresnel(std::cos(degrees * kDegree), 1.82, 1.0);
    for (const double polarisation : {0.0, 0.5 * kPi, 0.7, -1.0}) {  // -1: unpolarised
      double law = expected.unpolarised();
      if (polarisation >= 0.0)
        law = expected.reflectance_s * std::pow(std::cos(polarisation), 2) +
              expected.reflectance_p * std::pow(std::sin(polarisation), 2);
      std::uint64_t reflected = 0;
      for (std::uint64_t i = 0; i < kRays; ++i) {
        Rng rng(2, StreamKind::other, i);
        Ray ray = incident(degrees * kDegree, polarisation);
        if (polarisation < 0.0) ray.polarisation = Vec3::Zero();
        reflected += !interact_at_facet(ray, kNormal, 1.82, 1.0, rng);
      }
      CAPTURE(degrees);
      CAPTURE(polarisation);
      const double error = std::sqrt(std::max(law * (1.0 - law), 1.0 / kRays) / kRays);
      CHECK(std::abs(static_cast<double>(reflected) / kRays - law) < kSigmas * error);
    }
  }
}

TEST_CASE("Light is transmitted from the random number on that is its reflectance") {
  const core::Triple<double> normal = triple(kNormal);
  for (const std::pair<double, double>& indices : {std::pair{1.82, 1.0}, {1.0, 1.82}, {1.82, 1.5}})
    for (const double degrees : {0.001, 5.0, 20.0, 33.0})
      for (const double polarisation : {0.0, 0.5 * kPi, 0.7}) {
        const double n1 = indices.first, n2 = indices.second;
        CAPTURE(n1);
        CAPTURE(degrees);
        CAPTURE(polarisation);
        const double cos_i = std::cos(degrees * kDegree);
        const FresnelCoefficients expected = fresnel(cos_i, n1, n2);
        const Ray ray = incident(degrees * kDegree, polarisation);
        const LightRay<double> light{triple(ray.direction), triple(ray.polarisation)};
        FacetLight<double> facet(light, normal, cos_i, Refraction(cos_i, n1, n2), n1, n2);
        const double mixed = expected.reflectance_s * std::pow(std::cos(polarisation), 2) +
                             expected.reflectance_p * std::pow(std::sin(polarisation), 2);
        constexpr double kBelow = 1.0 - 1e-10, kAbove = 1.0 + 1e-10;
        CHECK_FALSE(facet.transmits_polarised(kBelow * mixed));
        CHECK(facet.transmits_polarised(kAbove * mixed));
        CHECK_FALSE(facet.transmits_unpolarised(kBelow * expected.unpolarised()));
        CHECK(facet.transmits_unpolarised(kAbove * expected.unpolarised()));
        CHECK_FALSE(facet.transmits_straight(kBelow * expected.reflectance_s));
        CHECK(facet.transmits_straight(kAbove * expected.reflectance_s));
      }
}

TEST_CASE("Beyond the critical angle everything is reflected as by a mirror") {
  for (const double degrees : {33.34, 45.0, 80.0, 89.999}) {
    Rng rng(3, StreamKind::other, 0);
    Ray ray = incident(degrees * kDegree, 0.9);
    const Vec3 expected = mirror(ray.direction, kNormal);
    CHECK_FALSE(interact_at_facet(ray, kNormal, 1.82, 1.0, rng));
    CHECK((ray.direction - expected).norm() < 1e-14);
    CHECK(std::abs(ray.polarisation.dot(ray.direction)) < 1e-12);
  }
}
