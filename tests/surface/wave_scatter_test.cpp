#include "scintray/optics/wave_scatter.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "scintray/core/statistics.hpp"
#include "scintray/optics/elliptical.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

using Amplitude = std::complex<double>;
constexpr double kLight_nm = 420.0;
constexpr double kCrystal = 1.82;
const Vec3 kPolished = Vec3(0.36, -0.48, 0.8);  // skew on purpose

Amplitude root(double square) { return std::sqrt(Amplitude(square, 0.0)); }

/// Amplitudes of reflected light from index 1 onto n by the theory of Rayleigh and Rice, as in SCATMECH's
/// urough.cpp (read): power per solid angle is 16 pi^2 / wavelength^4 cos(in) cos(out)^2 S times the square.
ScatterAmplitudes rice(double in, double out, double turn, double n) {
  const double e = n * n, si = std::sin(in), ss = std::sin(out), ci = std::cos(in), cs = std::cos(out);
  const Amplitude ri = root(e - si * si), rs = root(e - ss * ss);
  const double c = std::cos(turn), s = std::sin(turn);
  return {(e - 1) * c / ((ci + ri) * (cs + rs)), -(e - 1) * ri * s / ((e * ci + ri) * (cs + rs)),
          -(e - 1) * rs * s / ((ci + ri) * (e * cs + rs)),
          (e - 1) * (e * si * ss - rs * ri * c) / ((e * ci + ri) * (e * cs + rs)), 0.0};
}

/// The same of transmitted light, by Elson's theory: power per solid angle is 16 pi^2 / wavelength^4 cos(out)
/// S times the square.
ScatterAmplitudes elson(double in, double out, double turn, double n) {
  const double e = n * n, k0 = std::sin(in), k = std::sin(out) * n;
  const Amplitude q00 = root(e - k0 * k0), q10 = root(e - k * k), q01 = root(1.0 - k0 * k0),
                  q11 = root(1.0 - k * k);
  const double c = std::cos(turn), s = std::sin(turn);
  const Amplitude common = (1.0 - e) * n * std::sqrt(q10 * q01);
  return {common * c / ((q00 + q01) * (q10 + q11)), -common * q00 * s / ((q00 + e * q01) * (q10 + q11)),
          common * n * q11 * s / ((q00 + q01) * (q10 + e * q11)),
          common * n * (k * k0 + c * q00 * q11) / ((q00 + e * q01) * (q10 + e * q11)), 0.0};
}

struct PolarisedShares {
  double s_s, s_p, p_s, p_p;
};
PolarisedShares squares_of(const ScatterAmplitudes& a, double factor) {
  return {factor * std::norm(a.s_s), factor * std::norm(a.s_p), factor * std::norm(a.p_s),
          factor * std::norm(a.p_p())};
}

void check_equal(const PolarisedShares& ours, const PolarisedShares& published) {
  CHECK(ours.s_s == doctest::Approx(published.s_s).epsilon(1e-9));
  CHECK(ours.s_p == doctest::Approx(published.s_p).epsilon(1e-9));
  CHECK(ours.p_s == doctest::Approx(published.p_s).epsilon(1e-9));
  CHECK(ours.p_p == doctest::Approx(published.p_p).epsilon(1e-9));
}

/// Power per solid angle and height spectrum, times wavelength^4 / 16 pi^2, from index n1 onto n2.
PolarisedShares per_spectrum(double in, double out, double turn, std::array<double, 2> n, bool crosses) {
  const double from = crosses ? n[1] : n[0], onto = crosses ? n[0] : n[1];
  const ScatterAmplitudes a =
      scatter_amplitudes(face_fields(n[0] * std::sin(in), n[0], n[1]),
                         face_fields(from * std::sin(out), from, onto), sincos(turn), crosses);
  const double contrast = n[1] * n[1] - n[0] * n[0];
  return squares_of(a, from / (n[0] * std::cos(in)) * contrast * contrast / 16.0);
}

/// Light from the side of index n1, its electric field at an angle to s.
Ray incident(double angle, double polarisation, const Vec3& into) {
  const Frame frame = Frame::about(into);
  Ray ray{std::cos(angle) * into + std::sin(angle) * frame.x, Vec3::Zero()};
  const Vec3 s = ray.direction.cross(Vec3(-into)).normalized();
  ray.polarisation = std::cos(polarisation) * s + std::sin(polarisation) * s.cross(ray.direction.vec());
  return ray;
}

}  // namespace

TEST_CASE("Wave scattering: reflected light of first order is that of Rayleigh and Rice") {
  for (const double n : {1.5, 1.82, 1.0 / 1.82})
    for (const double in : {0.0, 0.3, 0.5, 1.2})
      for (const double out : {0.1, 0.4, 0.9, 1.4})
        for (const double turn : {0.0, 0.7, 2.0, kPi}) {
          const double factor = std::cos(in) * std::pow(std::cos(out), 2);
          check_equal(per_spectrum(in, out, turn, {1.0, n}, false),
                      squares_of(rice(in, out, turn, n), factor));
        }
}

TEST_CASE("Wave scattering: transmitted light of first order is that of Elson") {
  for (const double n : {1.5, 1.82})
    for (const double in : {0.0, 0.3, 0.5, 1.2})
      for (const double out : {0.1, 0.4, 0.9, 1.4})  // beyond the critical angle too: no direction in air
        for (const double turn : {0.0, 0.7, 2.0, kPi})
          check_equal(per_spectrum(in, out, turn, {1.0, n}, true),
                      squares_of(elson(in, out, turn, n), std::cos(out)));
}

TEST_CASE("Wave scattering: the transmittance is the same in both directions of the light") {
  const GaussianSpectrum fine(5.0, 40.0), coarse(5.0, 800.0);
  const KCorrelationSpectrum fractal(5.0, 2000.0, 1.6);
  for (const HeightSpectrum* spectrum :
       {static_cast<const HeightSpectrum*>(&fine), static_cast<const HeightSpectrum*>(&coarse),
        static_cast<const HeightSpectrum*>(&fractal)})
    for (const double transverse : {0.0, 0.3, 0.6, 0.874, 0.97}) {
      CAPTURE(transverse);
      const auto inside = specular_shares(transverse, kCrystal, 1.0, kLight_nm, *spectrum);
      const auto outside = specular_shares(transverse, 1.0, kCrystal, kLight_nm, *spectrum);
      for (std::size_t k = 0; k < 2; ++k) {
        CAPTURE(k);
        CHECK(inside[k].scattered > 0.0);
        // Of second order, as the shares themselves; sums over 64 frequencies and 48 azimuths.
        CHECK(std::abs(inside[k].lost_transmittance - outside[k].lost_transmittance) <
              2e-3 * (inside[k].scattered + outside[k].scattered));
      }
    }
}

TEST_CASE("Wave scattering: long waves of height only shift the phase of the light") {
  constexpr double kRms_nm = 4.0;
  const GaussianSpectrum spectrum(kRms_nm, 100.0 * kLight_nm);
  for (const double degrees : {0.0, 15.0, 30.0}) {
    const double sine = std::sin(degrees * kDegree), cosine = std::cos(degrees * kDegree);
    const double refracted = std::sqrt(1.0 - std::pow(kCrystal * sine, 2));
    const FresnelCoefficients smooth = fresnel(cosine, kCrystal, 1.0);
    const auto shares = specular_shares(kCrystal * sine, kCrystal, 1.0, kLight_nm, spectrum);
    for (std::size_t k = 0; k < 2; ++k) {
      const double reflectance = k == 0 ? smooth.reflectance_s : smooth.reflectance_p;
      const double wave_number = kTwoPi / kLight_nm * kRms_nm;
      // Phases of waves reflected and transmitted by a face at another height.
      const double reflected = std::pow(2.0 * wave_number * kCrystal * cosine, 2),
                   transmitted = std::pow(wave_number * (kCrystal * cosine - refracted), 2);
      CHECK(shares[k].lost_transmittance == doctest::Approx((1.0 - reflectance) * transmitted).epsilon(5e-3));
      CHECK(shares[k].scattered ==
            doctest::Approx(reflectance * reflected + (1.0 - reflectance) * transmitted).epsilon(5e-3));
    }
  }
}

TEST_CASE("Wave scattering: photons by the shares and the first order's directions, in every polarisation") {
  const auto spectrum = std::make_shared<KCorrelationSpectrum>(9.0, 1500.0, 2.2);
  const WaveScatterSurface surface(spectrum, {{kLight_nm, kCrystal, 1.0}});
  CHECK(surface.most_scattered() < 0.2);
  constexpr std::uint64_t kRays = 100'000;
  struct Case {
    Side side;
    double degrees, polarisation_deg;
  };
  for (const Case& at :
       {Case{Side::inside, 20.0, 0.0}, Case{Side::inside, 20.0, 90.0}, Case{Side::inside, 50.0, 90.0},
        Case{Side::inside, 60.0, 35.0}, Case{Side::outside, 45.0, 90.0}}) {
    CAPTURE(at.degrees);
    CAPTURE(at.polarisation_deg);
    const double angle = at.degrees * kDegree, from_s = at.polarisation_deg * kDegree;
    const double n1 = at.side == Side::inside ? kCrystal : 1.0, n2 = at.side == Side::inside ? 1.0 : kCrystal;
    const double transverse = n1 * std::sin(angle);
    const Vec3 into = at.side == Side::inside ? kPolished : Vec3(-kPolished);
    std::uint64_t specular = 0, through = 0, scattered_back = 0, scattered_on = 0;
    Moments s_of_back;  // share of s of light scattered back
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(11, StreamKind::other, i);
      Ray ray = incident(angle, from_s, into);
      const Ray before = ray;
      SurfaceInteraction interaction{kPolished, Vec3::Zero(), kLight_nm, rng};
      const SurfaceOutcome outcome = surface.scatter(ray, at.side, {kCrystal, 1.0}, interaction);
      REQUIRE(outcome != SurfaceOutcome::absorbed);
      REQUIRE((outcome == SurfaceOutcome::inside) == (ray.direction.dot(kPolished) < 0.0));
      REQUIRE(std::abs(ray.polarisation.dot(ray.direction.vec())) < 1e-9);
      REQUIRE(std::abs(ray.polarisation.norm() - 1.0) < 1e-9);
      const bool back = (outcome == SurfaceOutcome::inside) == (at.side == Side::inside);
      const double n = back ? n1 : n2;
      const Vec3 lateral = n * (ray.direction - ray.direction.dot(into) * into) -
                           n1 * (before.direction - before.direction.dot(into) * into);
      if (lateral.norm() < 1e-9) {
        ++(back ? specular : through);
      } else if (back) {
        ++scattered_back;
        const Vec3 s = ray.direction.cross(into).normalized();
        s_of_back.add(std::pow(ray.polarisation.dot(s), 2));
      } else {
        ++scattered_on;
      }
    }
    // Sums of the first order over directions, with the field's two components.
    double back_law = 0.0, on_law = 0.0, s_law = 0.0;
    const double limit = (transverse + kCrystal) / kLight_nm, variance = spectrum->variance_nm2(limit);
    const double factor =
        std::pow(kTwoPi / kLight_nm * (n2 * n2 - n1 * n1), 2) * variance / (4.0 * n1 * std::cos(angle));
    constexpr int kSteps = 400, kTurns = 180;
    for (int i = 0; i < kSteps; ++i)
      for (int k = 0; k < kTurns; ++k) {
        const double added = kLight_nm * spectrum->frequency_per_nm((i + 0.5) / kSteps, limit);
        const SineCosine about = sincos(kTwoPi * (k + 0.5) / kTurns);
        const double x = transverse + added * about.cosine, y = added * about.sine, length = std::hypot(x, y);
        for (const bool crosses : {false, true}) {
          const double from = crosses ? n2 : n1, onto = crosses ? n1 : n2;
          if (length >= from) continue;
          const ScatterAmplitudes a =
              scatter_amplitudes(face_fields(transverse, n1, n2), face_fields(length, from, onto),
                                 {y / length, x / length}, crosses);
          const double scale = factor / (kSteps * kTurns * std::sqrt(from * from - length * length));
          const double s = scale * std::norm(a.s_s * std::cos(from_s) + a.s_p * std::sin(from_s)),
                       p = scale * std::norm(a.p_s * std::cos(from_s) + a.p_p() * std::sin(from_s));
          (crosses ? on_law : back_law) += s + p;
          if (!crosses) s_law += s;
        }
      }
    const auto check_share = [&](std::uint64_t counted, double law, double of_law) {
      CHECK(std::abs(static_cast<double>(counted) / kRays - law) <=
            kSigmas * std::sqrt(law * (1.0 - law) / kRays) + of_law * law);
    };
    check_share(scattered_back, back_law, 3e-3);
    check_share(scattered_on, on_law, 3e-3);
    CHECK(sigmas(s_of_back.mean(), {s_law / back_law, 2e-3}) < kSigmas);
    const auto shares = specular_shares(transverse, n1, n2, kLight_nm, *spectrum);
    const FresnelCoefficients smooth = fresnel(std::cos(angle), n1, n2);
    const double share_of_s = std::pow(std::cos(from_s), 2);
    const double transmitted =
        share_of_s * (1.0 - smooth.reflectance_s - shares[0].lost_transmittance) +
        (1.0 - share_of_s) * (1.0 - smooth.reflectance_p - shares[1].lost_transmittance);
    check_share(through, transmitted, 1e-3);
    CHECK(specular + through + scattered_back + scattered_on == kRays);
  }
}

TEST_CASE("Wave scattering: spectra give their variance and the frequencies below which its shares lie") {
  const GaussianSpectrum gaussian(3.0, 200.0);
  const KCorrelationSpectrum fractal(3.0, 4000.0, 1.7);
  const TabulatedSpectrum table({1e-5, 1e-4, 1e-3, 2e-3, 3e-3}, {1e9, 1e9, 1e5, 0.0, 0.0});
  const auto tabulated = [](double f) {
    if (f < 1e-5 || f > 2e-3) return 0.0;
    if (f < 1e-4) return 1e9;
    return f < 1e-3 ? 1e9 * std::pow(f / 1e-4, -4.0) : 1e5 * (2e-3 - f) / 1e-3;
  };
  double sum = 0.0;
  constexpr int kSteps = 200'000;
  for (int k = 0; k < kSteps; ++k) {
    const double f = 2.1e-3 * (k + 0.5) / kSteps;
    sum += kTwoPi * f * tabulated(f) * 2.1e-3 / kSteps;
  }
  CHECK(table.variance_nm2(1.0) == doctest::Approx(sum).epsilon(1e-4));
  CHECK(gaussian.variance_nm2(std::numeric_limits<double>::infinity()) == doctest::Approx(9.0));
  CHECK(fractal.variance_nm2(std::numeric_limits<double>::infinity()) == doctest::Approx(9.0));
  for (const HeightSpectrum* spectrum :
       {static_cast<const HeightSpectrum*>(&gaussian), static_cast<const HeightSpectrum*>(&fractal),
        static_cast<const HeightSpectrum*>(&table)})
    for (const double limit : {8e-5, 6e-4, 4e-3})
      for (const double share : {0.0, 0.1, 0.5, 0.999}) {
        const double f = spectrum->frequency_per_nm(share, limit);
        CHECK(f <= limit);
        CHECK(spectrum->variance_nm2(f) ==
              doctest::Approx(share * spectrum->variance_nm2(limit)).epsilon(1e-9));
      }
}
