#include "scintray/optics/elliptical.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/coherent_layers.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

using Complex = std::complex<double>;

const Vec3 kPlane = Vec3(0.36, -0.48, 0.8);  // normal of a face, skew on purpose

/// A ray onto the face from inside, with components e_s and e_p of its field.
Ray onto_face(double angle, Complex e_s, Complex e_p) {
  const Frame frame = Frame::about(kPlane);
  Ray ray{std::cos(angle) * kPlane + std::sin(angle) * frame.x, Vec3::Zero()};
  ray.keeps_phases = true;
  set_field(ray, ray.direction.cross(-kPlane).normalized(), {e_s, e_p});
  return ray;
}
Vec3 across_plane(const Ray& ray) { return ray.direction.cross(-kPlane).normalized(); }

/// Stokes parameters of a field, of unit intensity.
void check_stokes(const StokesParameters& found, Complex e_s, Complex e_p) {
  const double power = std::norm(e_s) + std::norm(e_p);
  const Complex product = e_s * std::conj(e_p) / power;
  CHECK(found.s1 == doctest::Approx((std::norm(e_s) - std::norm(e_p)) / power).epsilon(1e-12));
  CHECK(found.s2 == doctest::Approx(2.0 * product.real()).epsilon(1e-12));
  CHECK(found.s3 == doctest::Approx(2.0 * product.imag()).epsilon(1e-12));
}

const std::pair<Complex, Complex> kFields[] = {{1.0, 0.0},
                                               {0.0, 1.0},
                                               {1.0, 1.0},
                                               {1.0, -1.0},
                                               {1.0, {0.0, 1.0}},
                                               {{0.0, 1.0}, 1.0},
                                               {{0.3, -0.4}, {-1.2, 0.5}}};

}  // namespace

TEST_CASE("A state of polarisation is that of the field, of unit size, across the ray") {
  for (const auto& [e_s, e_p] : kFields) {
    const Ray ray = onto_face(0.7, e_s, e_p);
    check_stokes(stokes_of(ray, across_plane(ray)), e_s, e_p);
    CHECK(ray.polarisation.vec().norm() == doctest::Approx(1.0).epsilon(1e-14));
    CHECK(std::abs(ray.polarisation.dot(ray.direction)) < 1e-14);
    CHECK(std::abs(ray.ellipticity_rad) <= kPi / 4.0 + 1e-12);
    CHECK(stokes_of(ray, across_plane(ray)).s3 ==
          doctest::Approx(std::sin(2.0 * ray.ellipticity_rad)).epsilon(1e-12));
  }
}

TEST_CASE("Law: total reflection multiplies the components of a field by complex numbers of size 1") {
  constexpr double kInside = 1.82;
  for (const double angle : {0.6, 0.9, 1.3})
    for (const auto& [e_s, e_p] : kFields) {
      Rng rng(3, StreamKind::other, 1);
      Ray ray = onto_face(angle, e_s, e_p);
      const Vec3 s = across_plane(ray);
      CHECK_FALSE(interact_at_facet(ray, -kPlane, kInside, 1.0, rng));
      CHECK(ray.direction.dot(kPlane) == doctest::Approx(-std::cos(angle)).epsilon(1e-12));
      // The amplitudes of a bare face by the recursion for films, which admits complex angles too.
      const FilmResponse r = film_response(std::cos(angle), kInside, {}, 1.0, 500.0);
      CHECK(std::abs(r.r_s) == doctest::Approx(1.0).epsilon(1e-12));
      check_stokes(stokes_of(ray, s), r.r_s * e_s, r.r_p * e_p);
    }
}

TEST_CASE(
    "Law: shares and states of reflected and refracted elliptical light are those of Fresnel's amplitudes") {
  constexpr double kInside = 1.5, kOutside = 1.1, kAngle = 0.5;
  constexpr std::uint64_t kRays = 100'000;
  const double cos_i = std::cos(kAngle), cos_t = Refraction(cos_i, kInside, kOutside).cos_t();
  const FresnelAmplitudes r(cos_i, cos_t, kInside, kOutside);
  const double t_s = 1.0 + r.s, t_p = kInside / kOutside * (1.0 + r.p);
  for (const auto& [e_s, e_p] : kFields) {
    const double power_s = std::norm(e_s), power_p = std::norm(e_p);
    const double reflectance = (r.s * r.s * power_s + r.p * r.p * power_p) / (power_s + power_p);
    std::uint64_t reflected = 0;
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(4, StreamKind::other, i);
      Ray ray = onto_face(kAngle, e_s, e_p);
      const Vec3 s = across_plane(ray);
      const bool transmitted = interact_at_facet(ray, -kPlane, kInside, kOutside, rng);
      reflected += transmitted ? 0 : 1;
      if (i < 20) {
        if (transmitted)
          check_stokes(stokes_of(ray, s), t_s * e_s, t_p * e_p);
        else
          check_stokes(stokes_of(ray, s), r.s * e_s, r.p * e_p);
      }
    }
    CHECK(sigmas(binomial_estimate(reflected, kRays), {reflectance, 0.0}) < kSigmas);
  }
}

TEST_CASE(
    "Law: linear light that does not reach the critical angle has the same states and the same random "
    "numbers") {
  for (const double e_p : {0.0, 0.4, -2.0})
    for (std::uint64_t i = 0; i < 200; ++i) {
      Rng one(5, StreamKind::other, i), other(5, StreamKind::other, i);
      Ray keeps = onto_face(0.5, 1.0, e_p), linear = keeps;
      linear.keeps_phases = false;
      CHECK(interact_at_facet(keeps, -kPlane, 1.5, 1.1, one) ==
            interact_at_facet(linear, -kPlane, 1.5, 1.1, other));
      CHECK(keeps.direction.vec().isApprox(linear.direction.vec(), 1e-14));
      CHECK(std::abs(keeps.polarisation.dot(linear.polarisation)) == doctest::Approx(1.0).epsilon(1e-12));
      CHECK(std::abs(keeps.ellipticity_rad) < 1e-12);
    }
}

TEST_CASE("Law: aluminium makes linear light elliptical by the phases of its complex amplitudes") {
  MetalSurface metal;
  metal.metal = MetalIndex{Curve::constant(0.77), Curve::constant(6.08)};
  const FilmResponse r = film_response(std::cos(1.2), 1.0, {}, {0.77, 6.08}, 500.0);
  int reflected = 0;
  for (std::uint64_t i = 0; i < 50; ++i) {
    Rng rng(6, StreamKind::other, i);
    Ray ray = onto_face(1.2, 1.0, 1.0);
    const Vec3 s = across_plane(ray);
    SurfaceInteraction at{kPlane, Vec3::Zero(), 500.0, rng};
    if (metal.scatter(ray, Side::inside, {1.0, 1.0}, at) != SurfaceOutcome::inside) continue;
    ++reflected;
    check_stokes(stokes_of(ray, s), r.r_s, r.r_p);
    CHECK(std::abs(stokes_of(ray, s).s3) > 0.1);
  }
  CHECK(reflected > 30);
}

TEST_CASE("A mirror changes the handedness of light, twice and it is as before") {
  Ray ray = onto_face(0.4, 1.0, {0.2, 0.9});
  const Ray before = ray;
  reflect(ray, kPlane);
  CHECK(ray.ellipticity_rad == -before.ellipticity_rad);
  // A perfect conductor: the field along the face changes sign, that along its normal does not.
  const FieldComponents field = field_of(before, across_plane(before));
  check_stokes(stokes_of(ray, across_plane(before)), -field.s, field.p);
  reflect(ray, kPlane);
  CHECK(ray.polarisation.vec().isApprox(before.polarisation.vec(), 1e-14));
}

TEST_CASE("Law of Rayleigh scattering of elliptical light: what a dipole radiates along a direction") {
  const Ray ray = onto_face(0.4, 1.0, {0.0, 1.0});
  CHECK(power_across(ray, ray.direction.vec()) == doctest::Approx(1.0).epsilon(1e-12));
  // Circular light: (1 + cos^2) / 2.
  const Vec3 side = std::cos(1.0) * ray.direction + std::sin(1.0) * across_plane(ray);
  CHECK(power_across(ray, side) == doctest::Approx(0.5 * (1.0 + std::pow(std::cos(1.0), 2))).epsilon(1e-12));
  Ray scattered = ray;
  REQUIRE(project_field(scattered, side));
  // Seen at 57 deg the circle is an ellipse of axes 1 and cos(1).
  CHECK(std::abs(std::tan(scattered.ellipticity_rad)) == doctest::Approx(std::cos(1.0)).epsilon(1e-12));
}
