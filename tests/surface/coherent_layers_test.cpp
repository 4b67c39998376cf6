#include "scintray/optics/coherent_layers.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/statistics.hpp"
#include "scintray/optics/surface.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

using ComplexIndex = std::complex<double>;
constexpr double kFilmNm = 550.0;
const Vec3 kFace = Vec3(0.36, -0.48, 0.8);  // skew on purpose
constexpr std::uint64_t kFilmRays = 200'000;

/// Light from inside, its electric field at an angle to s; below 0: unpolarised.
Ray from_inside(double angle, double polarisation_angle) {
  const Frame frame = Frame::about(kFace);
  Ray ray{std::cos(angle) * kFace + std::sin(angle) * frame.x, Vec3::Zero()};
  if (polarisation_angle < 0.0) return ray;
  const Vec3 s = ray.direction.cross(-kFace).normalized();
  ray.polarisation =
      std::cos(polarisation_angle) * s + std::sin(polarisation_angle) * s.cross(ray.direction.vec());
  return ray;
}

struct FilmShares {
  std::uint64_t reflected = 0, transmitted = 0, absorbed = 0;
  Moments in_phase;  ///< 2 E_s E_p of reflected light, of unit intensity
};

FilmShares shine_on(const MicrosurfaceModel& surface, double angle, double polarisation,
                    const IndexPair& index) {
  FilmShares shares;
  for (std::uint64_t i = 0; i < kFilmRays; ++i) {
    Rng rng(5, StreamKind::other, i);
    Ray ray = from_inside(angle, polarisation);
    const Vec3 s = ray.direction.cross(-kFace).normalized();
    SurfaceInteraction at{kFace, Vec3::Zero(), kFilmNm, rng};
    switch (surface.scatter(ray, Side::inside, index, at)) {
      case SurfaceOutcome::inside:
        ++shares.reflected;
        REQUIRE(ray.direction.dot(kFace) < 0.0);
        shares.in_phase.add(2.0 * ray.polarisation.dot(s) *
                            ray.polarisation.dot(s.cross(ray.direction.vec())));
        break;
      case SurfaceOutcome::outside:
        ++shares.transmitted;
        REQUIRE(ray.direction.dot(kFace) > 0.0);
        CHECK(ray.direction.cross(kFace).norm() * index.outside ==
              doctest::Approx(std::sin(angle) * index.inside).epsilon(1e-9));
        break;
      case SurfaceOutcome::absorbed:
        ++shares.absorbed;
        break;
    }
  }
  return shares;
}

void check_film_share(std::uint64_t counted, double law) {
  const double error =
      std::sqrt(std::max(law * (1.0 - law), 1.0 / static_cast<double>(kFilmRays)) / kFilmRays);
  CHECK(std::abs(static_cast<double>(counted) / kFilmRays - law) < kSigmas * error);
}

}  // namespace

TEST_CASE("Films: none at all is Fresnel's face, amplitudes and total reflection included") {
  for (const auto& [n1, n2] : {std::pair{1.82, 1.0}, std::pair{1.0, 1.82}, std::pair{1.5, 1.46}})
    for (double degrees = 0.0; degrees < 89.5; degrees += 3.0) {
      const double cosine = std::cos(degrees * kDegree);
      const FilmResponse film = film_response(cosine, n1, {}, n2, kFilmNm);
      const FresnelCoefficients law = fresnel(cosine, n1, n2);
      CHECK(film.reflectance_s == doctest::Approx(law.reflectance_s).epsilon(1e-9));
      CHECK(film.reflectance_p == doctest::Approx(law.reflectance_p).epsilon(1e-9));
      CHECK(film.transmittance() == doctest::Approx(1.0 - law.unpolarised()).epsilon(1e-9));
      if (Refraction(cosine, n1, n2).total()) continue;
      const FresnelAmplitudes amplitude(cosine, law.cos_refracted, n1, n2);
      CHECK(film.r_s.real() == doctest::Approx(amplitude.s).epsilon(1e-9));
      CHECK(film.r_p.real() == doctest::Approx(amplitude.p).epsilon(1e-9));
    }
}

TEST_CASE("Total reflection: a Fresnel rhomb of two reflections retards by a quarter of a wave") {
  // tan(delta / 2) = cos sqrt(sin^2 - (1 / n)^2) / sin^2 between p and s (M. Born and E. Wolf, section 1.5.4,
  // cited from memory, whose glass of n = 1.51 makes 45 deg at 48 deg 37' and at 54 deg 37').
  constexpr double kGlass = 1.51;
  const auto retardation = [](double angle) {
    const FilmResponse response = film_response(std::cos(angle), kGlass, {}, 1.0, 500.0);
    CHECK(std::abs(response.r_s) == doctest::Approx(1.0));
    CHECK(std::abs(response.r_p) == doctest::Approx(1.0));
    // Reflected p is counted with the sign that makes both equal at normal incidence, or opposite.
    const double phase = std::arg(response.r_p / response.r_s);
    return std::abs(std::remainder(phase, kPi));
  };
  for (double degrees = 42.0; degrees < 89.0; degrees += 2.0) {
    const double sine = std::sin(degrees * kDegree), cosine = std::cos(degrees * kDegree);
    const double half = std::atan(cosine * std::sqrt(sine * sine - 1.0 / (kGlass * kGlass)) / (sine * sine));
    CAPTURE(degrees);
    CHECK(retardation(degrees * kDegree) == doctest::Approx(2.0 * half).epsilon(1e-9));
  }
  for (const double degrees : {48.0 + 37.0 / 60.0, 54.0 + 37.0 / 60.0})
    CHECK(retardation(degrees * kDegree) / kDegree == doctest::Approx(45.0).epsilon(2e-3));
}

TEST_CASE(
    "Films: a quarter wave of index n1 reflects ((n0 n2 - n1^2) / (n0 n2 + n1^2))^2, nothing at the "
    "geometric mean") {
  for (const double n1 : {1.2, 1.38, std::sqrt(1.52), 2.3}) {
    const Film film{n1, kFilmNm / (4.0 * n1)};
    const double law = std::pow((1.52 - n1 * n1) / (1.52 + n1 * n1), 2);
    CHECK(film_response(1.0, 1.0, {&film, 1}, 1.52, kFilmNm).reflectance() ==
          doctest::Approx(law).epsilon(1e-9).scale(1e-6));
  }
  // A mirror of N pairs of quarter waves: admittance n2 (nH / nL)^2N.
  std::vector<Film> stack;
  for (int pair = 0; pair < 6; ++pair) {
    stack.push_back({2.3, kFilmNm / (4.0 * 2.3)});
    stack.push_back({1.38, kFilmNm / (4.0 * 1.38)});
  }
  const double admittance = 1.52 * std::pow(2.3 / 1.38, 12);
  CHECK(film_response(1.0, 1.0, stack, 1.52, kFilmNm).reflectance() ==
        doctest::Approx(std::pow((1.0 - admittance) / (1.0 + admittance), 2)).epsilon(1e-9));
}

TEST_CASE("Films: a plate in one medium transmits as Airy's function, in s and p") {
  constexpr double kThickness = 1234.5, kIndex = 2.1;
  for (double degrees = 0.0; degrees < 88.0; degrees += 7.0) {
    const double cosine = std::cos(degrees * kDegree);
    const FresnelCoefficients face = fresnel(cosine, 1.0, kIndex);
    const double delta = kTwoPi * 2.0 * kThickness * kIndex * face.cos_refracted / kFilmNm;
    const auto airy = [&](double r) {
      return 1.0 / (1.0 + 4.0 * r / std::pow(1.0 - r, 2) * std::pow(std::sin(0.5 * delta), 2));
    };
    const Film film{kIndex, kThickness};
    const FilmResponse response = film_response(cosine, 1.0, {&film, 1}, 1.0, kFilmNm);
    CHECK(response.transmittance_s == doctest::Approx(airy(face.reflectance_s)).epsilon(1e-9));
    CHECK(response.transmittance_p == doctest::Approx(airy(face.reflectance_p)).epsilon(1e-9));
  }
}

TEST_CASE(
    "Films: an air gap between prisms transmits beyond the critical angle (frustrated total reflection)") {
  constexpr double kGlass = 1.5;
  for (const double thickness : {20.0, 100.0, 400.0, 1000.0})
    for (const double degrees : {42.0, 45.0, 60.0, 80.0}) {
      const double sine = kGlass * std::sin(degrees * kDegree), q = kGlass * std::cos(degrees * kDegree);
      const double kappa = std::sqrt(sine * sine - 1.0);
      const auto barrier = [&](double y, double k) {
        const double x = std::sinh(kTwoPi * thickness * kappa / kFilmNm);
        return 1.0 / (1.0 + std::pow((y * y + k * k) / (2.0 * y * k), 2) * x * x);
      };
      const Film film{1.0, thickness};
      const FilmResponse response =
          film_response(std::cos(degrees * kDegree), kGlass, {&film, 1}, kGlass, kFilmNm);
      CHECK(response.transmittance_s == doctest::Approx(barrier(q, kappa)).epsilon(1e-8));
      CHECK(response.transmittance_p == doctest::Approx(barrier(q / (kGlass * kGlass), kappa)).epsilon(1e-8));
    }
  // A gap of a millimetre overflows in a product of matrices.
  const Film wide{1.0, 1e6};
  const FilmResponse total = film_response(std::cos(60.0 * kDegree), kGlass, {&wide, 1}, kGlass, kFilmNm);
  CHECK(total.reflectance() == doctest::Approx(1.0));
  CHECK(total.transmittance() == 0.0);
}

TEST_CASE("Films: energy, and equal transmittance from both sides, absorbing films included") {
  const std::vector<Film> clear{{1.38, 90.0}, {2.4, 47.0}, {1.0, 130.0}, {1.9, 310.0}};
  const std::vector<Film> dark{{1.38, 90.0}, {ComplexIndex(2.4, 0.3), 47.0}, {ComplexIndex(0.9, 5.0), 12.0}};
  for (const std::vector<Film>& films : {clear, dark}) {
    const std::vector<Film> back(films.rbegin(), films.rend());
    for (double degrees = 0.0; degrees < 89.0; degrees += 4.0) {
      const double cosine = std::cos(degrees * kDegree);
      const FilmResponse in = film_response(cosine, 1.0, films, 1.82, kFilmNm);
      const double sine = std::sin(degrees * kDegree) / 1.82;
      const FilmResponse out = film_response(std::sqrt(1.0 - sine * sine), 1.82, back, 1.0, kFilmNm);
      CHECK(in.transmittance_s == doctest::Approx(out.transmittance_s).epsilon(1e-9));
      CHECK(in.transmittance_p == doctest::Approx(out.transmittance_p).epsilon(1e-9));
      if (&films == &dark || films.size() == dark.size()) {
        CHECK(in.reflectance_s + in.transmittance_s < 1.0);
      } else {
        CHECK(in.reflectance_s + in.transmittance_s == doctest::Approx(1.0).epsilon(1e-12));
        CHECK(in.reflectance_p + in.transmittance_p == doctest::Approx(1.0).epsilon(1e-12));
        CHECK(in.reflectance_s == doctest::Approx(out.reflectance_s).epsilon(1e-9));
      }
    }
  }
  // A thick film of the media's own index absorbs by Lambert and Beer: k is too small to reflect.
  const Film grey{ComplexIndex(1.5, 1e-5), 20'000.0};
  for (const double degrees : {0.0, 40.0, 70.0}) {
    const double cosine = std::cos(degrees * kDegree);
    CHECK(film_response(cosine, 1.5, {&grey, 1}, 1.5, kFilmNm).transmittance() ==
          doctest::Approx(std::exp(-2.0 * kTwoPi * 1e-5 * 20'000.0 / (kFilmNm * cosine))).epsilon(1e-4));
  }
}

TEST_CASE("Metals: aluminium at 0 to 89 deg in s and p, by the formulas in real numbers") {
  // Born and Wolf, section 14.2; the real form is that of R. W. Ditchburn, Light (cited from memory): with
  // 2 a^2, 2 b^2 = sqrt((n^2 - k^2 - sin^2)^2 + 4 n^2 k^2) +- (n^2 - k^2 - sin^2).
  constexpr double n = 0.958, k = 6.69;
  for (int degrees = 0; degrees <= 89; ++degrees) {
    const double sine = std::sin(degrees * kDegree), cosine = std::cos(degrees * kDegree);
    const double d = n * n - k * k - sine * sine;
    const double root = std::sqrt(d * d + 4.0 * n * n * k * k);
    const double a2 = 0.5 * (root + d), b2 = 0.5 * (root - d), a = std::sqrt(a2);
    const double st = sine * sine / cosine;
    const double r_s =
        (a2 + b2 - 2.0 * a * cosine + cosine * cosine) / (a2 + b2 + 2.0 * a * cosine + cosine * cosine);
    const double r_p = r_s * (a2 + b2 - 2.0 * a * st + st * st) / (a2 + b2 + 2.0 * a * st + st * st);
    const FilmResponse film = film_response(cosine, 1.0, {}, ComplexIndex(n, k), kFilmNm);
    CAPTURE(degrees);
    CHECK(film.reflectance_s == doctest::Approx(r_s).epsilon(1e-10));
    CHECK(film.reflectance_p == doctest::Approx(r_p).epsilon(1e-10));
  }
}

TEST_CASE("Films and metals: photons are reflected, transmitted and absorbed by their polarisation") {
  const ThinFilmSurface film({{Curve::constant(1.38), Curve::constant(0.0), 60.0},
                              {Curve::constant(2.1), Curve::constant(0.2), 80.0}});
  const std::vector<Film> films{{1.38, 60.0}, {ComplexIndex(2.1, 0.2), 80.0}};
  MetalSurface metal;
  metal.metal = MetalIndex{Curve::constant(0.958), Curve::constant(6.69)};
  CHECK(metal.opaque());
  constexpr IndexPair kIndex{1.5, 1.2};
  for (const double degrees : {0.0, 30.0, 50.0, 75.0})
    for (const double polarisation : {-1.0, 0.0, 0.5 * kPi, 0.7}) {
      CAPTURE(degrees);
      CAPTURE(polarisation);
      const double angle = degrees * kDegree;
      const double share_s = polarisation < 0.0 ? 0.5 : std::pow(std::cos(polarisation), 2);
      const auto check = [&](const MicrosurfaceModel& surface, const FilmResponse& law, bool transmits) {
        const double reflectance = share_s * law.reflectance_s + (1.0 - share_s) * law.reflectance_p;
        const double transmittance =
            transmits ? share_s * law.transmittance_s + (1.0 - share_s) * law.transmittance_p : 0.0;
        const FilmShares shares = shine_on(surface, angle, polarisation, kIndex);
        CHECK(shares.reflected + shares.transmitted + shares.absorbed == kFilmRays);
        check_film_share(shares.reflected, reflectance);
        check_film_share(shares.transmitted, transmittance);
        if (polarisation != 0.7 || degrees == 0.0) return;
        // The third Stokes parameter: the phase between s and p counts by its cosine.
        const double stokes = 2.0 * (law.r_p * std::conj(law.r_s)).real() * std::cos(0.7) * std::sin(0.7);
        CHECK(sigmas(shares.in_phase.mean(), {stokes / reflectance, 0.0}) < kSigmas);
      };
      check(film, film_response(std::cos(angle), 1.5, films, 1.2, kFilmNm), true);
      check(metal, film_response(std::cos(angle), 1.5, {}, ComplexIndex(0.958, 6.69), kFilmNm), false);
    }
}

TEST_CASE("GLISUR: facets are the mean normal plus a point of a ball") {
  // A perfect metal at normal incidence: the reflected ray is turned by twice the angle of the facet.
  MetalSurface metal;
  metal.facets.smear = 0.5;
  metal.facets.sampling = FacetSampling::geant4;
  Moments cosine;
  for (std::uint64_t i = 0; i < kFilmRays; ++i) {
    Rng rng(6, StreamKind::other, i);
    Ray ray{kFace, Vec3::Zero()};
    SurfaceInteraction at{kFace, Vec3::Zero(), kFilmNm, rng};
    REQUIRE(metal.scatter(ray, Side::inside, {1.5, 1.0}, at) == SurfaceOutcome::inside);
    cosine.add(std::sqrt(0.5 * (1.0 - ray.direction.dot(kFace))));
  }
  // Mean cosine over the ball, by the midpoint rule in its radius and polar angle.
  constexpr int kSteps = 1000;
  double law = 0.0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double u = (i + 0.5) / kSteps, r = 0.5 * u, mu = -1.0 + 2.0 * (j + 0.5) / kSteps;
      law += 3.0 * u * u * (1.0 + r * mu) / std::sqrt(1.0 + 2.0 * r * mu + r * r);
    }
  law /= kSteps * static_cast<double>(kSteps);
  CHECK(sigmas(cosine.mean(), {law, 0.0}) < kSigmas);
}

TEST_CASE("Rough metals: every lobe leaves on the side of incidence, and nothing is lost without an index") {
  MetalSurface metal;
  metal.facets.sigma_alpha_rad = 0.3;
  metal.facets.sampling = FacetSampling::geant4;
  metal.facets.lobe = 0.4;
  metal.facets.spike = 0.2;
  metal.facets.backscatter = 0.1;
  std::uint64_t spikes = 0, back = 0;
  for (std::uint64_t i = 0; i < kFilmRays; ++i) {
    Rng rng(7, StreamKind::other, i);
    Ray ray = from_inside(1.2, 0.3);
    const Ray before = ray;
    SurfaceInteraction at{kFace, Vec3::Zero(), kFilmNm, rng};
    REQUIRE(metal.scatter(ray, Side::inside, {1.5, 1.0}, at) == SurfaceOutcome::inside);
    REQUIRE(ray.direction.dot(kFace) < 0.0);
    spikes += (ray.direction - mirror(before.direction, kFace)).norm() < 1e-12;
    back += (ray.direction + before.direction).norm() < 1e-12;
  }
  check_film_share(spikes, 0.2);
  check_film_share(back, 0.1);
}

TEST_CASE(
    "A surface admits its share of the light, passes another straight on, and absorbs the rest, on both "
    "sides") {
  Surface surface;
  surface.admission = Admission{Curve({400.0, 600.0}, {0.6, 0.8}), Curve::constant(0.15)};
  CHECK_FALSE(surface.plain());
  CHECK_FALSE(surface.opaque());
  for (const Side side : {Side::inside, Side::outside}) {
    std::uint64_t absorbed = 0, straight = 0;
    for (std::uint64_t i = 0; i < kFilmRays; ++i) {
      Rng rng(8, StreamKind::other, i);
      Ray ray = from_inside(0.3, 0.4);
      if (side == Side::outside) ray.direction = -ray.direction;
      const Ray before = ray;
      const SurfaceOutcome outcome = surface.interact(ray, side, kFace, {1.5, 1.0}, 500.0, rng);
      absorbed += outcome == SurfaceOutcome::absorbed;
      straight += ray.direction == before.direction && outcome == outcome_on(other(side));
    }
    check_film_share(absorbed, 1.0 - 0.7 - 0.15);
    check_film_share(straight, 0.15);
  }
  surface.admission = Admission{Curve::constant(0.0)};
  CHECK(surface.opaque());
}

TEST_CASE("Films: facets with a film of the index behind are facets without films") {
  FacetSurface unified;
  unified.sigma_alpha_rad = 18.0 * kDegree;
  unified.lobe = 0.7;
  unified.backscatter = 0.1;
  FacetSurface smeared;
  smeared.smear = 0.3;
  smeared.sampling = FacetSampling::geant4;
  const IndexPair index{1.82, 1.4};
  for (const FacetSurface& facets : {unified, smeared}) {
    const ThinFilmSurface films({{Curve::constant(1.4), Curve::constant(0.0), 80.0}}, {}, facets);
    CHECK_FALSE(films.reciprocal());
    for (const Side side : {Side::inside, Side::outside})
      for (const double angle : {0.3, 0.8, 1.2}) {
        CAPTURE(angle);
        Moments crossed, cosine, along;  // of a film less those without: the same rays, other random numbers
        for (std::uint64_t i = 0; i < 20'000; ++i) {
          Ray ray = from_inside(angle, -1.0);
          if (side == Side::outside) ray.direction = -ray.direction;
          const Vec3 before = ray.direction;
          Ray bare = ray;
          Rng rng(8, StreamKind::other, i), other_rng(9, StreamKind::other, i);
          SurfaceInteraction at{kFace, Vec3::Zero(), kFilmNm, rng};
          const SurfaceOutcome outcome = films.scatter(ray, side, index, at);
          const Side bare_side = facets.scatter(bare, side, kFace, index, other_rng);
          REQUIRE((outcome == SurfaceOutcome::inside) == (ray.direction.dot(kFace) < 0.0));
          crossed.add((outcome != outcome_on(side) ? 1.0 : 0.0) - (bare_side != side ? 1.0 : 0.0));
          cosine.add(std::abs(ray.direction.dot(kFace)) - std::abs(bare.direction.dot(kFace)));
          along.add(ray.direction.dot(before) - bare.direction.dot(before));
        }
        for (const Moments* difference : {&crossed, &cosine, &along})
          CHECK(sigmas(difference->mean(), {0.0, 0.0}) < kSigmas);
      }
  }
}
