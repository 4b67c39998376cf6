#include <doctest/doctest.h>

#include <functional>

#include "scintray/core/statistics.hpp"
#include "scintray/optics/surface.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

constexpr std::uint64_t kRays = 200'000;

Estimate absorbed_share(const Surface& surface, double angle, Side side) {
  std::uint64_t absorbed = 0;
  const double z = side == Side::inside ? std::cos(angle) : -std::cos(angle);
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(1, StreamKind::other, i);
    Ray ray{Vec3(std::sin(angle), 0.0, z), Vec3::Zero()};
    absorbed +=
        surface.interact(ray, side, Vec3::UnitZ(), {1.82, 1.0}, 420.0, rng) == SurfaceOutcome::absorbed;
  }
  return binomial_estimate(absorbed, kRays);
}

}  // namespace

TEST_CASE("A mirror behind a gap: the geometric series of passes through the face") {
  // T (1 - rho) (1 + rho R + ...) = T (1 - rho) / (1 - rho R), R the same on both sides of the face.
  Surface stack;
  stack.reflector = Reflector{"mirror", Curve::constant(0.8), 1.0};
  const double angle = 20.0 * kDegree;
  const double r = fresnel(std::cos(angle), 1.82, 1.0).unpolarised();
  CHECK(sigmas(absorbed_share(stack, angle, Side::inside), {(1.0 - r) * 0.2 / (1.0 - 0.8 * r), 0.0}) <
        kSigmas);
}

TEST_CASE("A Lambertian reflector behind a gap: the series with the diffuse reflectance from outside") {
  // First interaction 1 - R; each return is incident on the face with the diffuse reflectance R21 = 0.136763.
  Surface stack;
  stack.reflector = Reflector{"paper", Curve::constant(0.9), 0.0};
  const double r = fresnel(1.0, 1.82, 1.0).unpolarised(), r21 = 0.136763;
  CHECK(sigmas(absorbed_share(stack, 0.0, Side::inside), {(1.0 - r) * 0.1 / (1.0 - 0.9 * r21), 0.0}) <
        kSigmas);
}

TEST_CASE("Paint on the face absorbs its share at once, from either side") {
  Surface painted;
  painted.microsurface = PaintedSurface{};
  painted.reflector = Reflector{"paint", Curve::constant(0.75), 0.5};
  CHECK(sigmas(absorbed_share(painted, 0.4, Side::inside), {0.25, 0.0}) < kSigmas);
  CHECK(sigmas(absorbed_share(painted, 0.4, Side::outside), {0.25, 0.0}) < kSigmas);
}

TEST_CASE("Reflectance follows the wavelength") {
  Surface painted;
  painted.microsurface = PaintedSurface{};
  painted.reflector = Reflector{"dye", Curve({400.0, 500.0}, {0.0, 1.0}), 1.0};
  Rng rng(5, StreamKind::other, 0);
  Ray ray{Vec3::UnitZ(), Vec3::Zero()};
  CHECK(painted.interact(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, 400.0, rng) ==
        SurfaceOutcome::absorbed);
  CHECK(painted.interact(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, 500.0, rng) ==
        SurfaceOutcome::inside);
}

TEST_CASE("An absorbing layer of stated thickness under a mirror: Beer and Lambert, there and back") {
  // q = rho exp(-2 alpha t / cos): T (1 - q) / (1 - q R) of the light is absorbed.
  Surface stack;
  stack.reflector = Reflector{"mirror", Curve::constant(0.9), 1.0};
  stack.gap_index = Curve::constant(1.5);
  stack.gap_absorption_per_mm = Curve::constant(2.0);
  stack.gap_thickness_um = 100.0;
  const double angle = 30.0 * kDegree;
  const double r = fresnel(std::cos(angle), 1.82, 1.5).unpolarised();
  const double cos_gap = std::sqrt(1.0 - std::pow(std::sin(angle) * 1.82 / 1.5, 2));
  const double q = 0.9 * std::exp(-2.0 * 2.0 * 0.1 / cos_gap);
  CHECK(sigmas(absorbed_share(stack, angle, Side::inside), {(1.0 - r) * (1.0 - q) / (1.0 - q * r), 0.0}) <
        kSigmas);
}

TEST_CASE("A layer without a reflector ends at the next medium: a lossless plate, from both sides") {
  // Incoherent plate between 1.82 and 1.0: T = T1 T2 / (1 - R1 R2), the same both ways.
  Surface layer;
  layer.gap_index = Curve::constant(1.5);
  layer.gap_thickness_um = 50.0;
  const double r1 = fresnel(1.0, 1.82, 1.5).unpolarised(), r2 = fresnel(1.0, 1.5, 1.0).unpolarised();
  const double law = (1.0 - r1) * (1.0 - r2) / (1.0 - r1 * r2);
  for (const Side side : {Side::inside, Side::outside}) {
    std::uint64_t through = 0;
    const SurfaceOutcome beyond = outcome_on(other(side));
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(2, StreamKind::other, i);
      Ray ray{side == Side::inside ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitZ()), Vec3::Zero()};
      through += layer.interact(ray, side, Vec3::UnitZ(), {1.82, 1.0}, 420.0, rng) == beyond;
    }
    CHECK(sigmas(binomial_estimate(through, kRays), {law, 0.0}) < kSigmas);
  }
  CHECK_FALSE(layer.opaque());
}

TEST_CASE("A mixture of couplings by area is the mean of its parts") {
  const auto painted = [](double reflectance) {
    auto surface = std::make_shared<Surface>();
    surface->microsurface = PaintedSurface{};
    surface->reflector = Reflector{"paint", Curve::constant(reflectance), 0.0};
    return surface;
  };
  Surface mixed;
  mixed.mixture = {{0.3, painted(0.9)}, {0.7, painted(0.2)}};
  CHECK(sigmas(absorbed_share(mixed, 0.5, Side::inside), {0.3 * 0.1 + 0.7 * 0.8, 0.0}) < kSigmas);
  CHECK(mixed.opaque());
  mixed.mixture[1].surface = std::make_shared<Surface>();
  CHECK_FALSE(mixed.opaque());
}

TEST_CASE("A volume-like reflector: light refracted in, scattered, and refracted out or kept") {
  // R = Rf + (1 - Rf) rho Td / (1 - rho (1 - Td)), Td the diffuse transmittance from within.
  const double n = 1.35, rho = 0.95;
  Surface volume;
  volume.microsurface = PaintedSurface{};
  volume.reflector = Reflector{"PTFE", Curve::constant(rho), 0.0, n};
  double diffuse = 0.0;  // of sin^2, by the midpoint rule
  constexpr int kSteps = 20'000;
  for (int k = 0; k < kSteps; ++k)
    diffuse += (1.0 - fresnel(std::sqrt(1.0 - (k + 0.5) / kSteps), n, 1.0).unpolarised()) / kSteps;
  const double rf = fresnel(std::cos(0.6), 1.0, n).unpolarised();
  const double law = rf + (1.0 - rf) * rho * diffuse / (1.0 - rho * (1.0 - diffuse));
  std::uint64_t absorbed = 0;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(3, StreamKind::other, i);
    Ray ray{Vec3(std::sin(0.6), 0.0, std::cos(0.6)), Vec3::Zero()};
    absorbed +=
        volume.interact(ray, Side::inside, Vec3::UnitZ(), {1.0, 1.0}, 420.0, rng) == SurfaceOutcome::absorbed;
  }
  CHECK(sigmas(binomial_estimate(absorbed, kRays), {1.0 - law, 0.0}) < kSigmas);
}

TEST_CASE("Law: weighted by their logged reflections, survivors of one reflectance are those of another") {
  const auto stack = [](double reflectance, double volume_index) {
    Surface surface;
    surface.reflector = Reflector{"sheet", Curve::constant(reflectance), 0.0, volume_index};
    return surface;
  };
  const auto mixed = [&](double reflectance) {
    Surface surface;
    surface.mixture = {{0.4, std::make_shared<Surface>(stack(reflectance, 0.0))},
                       {0.6, std::make_shared<Surface>(stack(reflectance, 1.35))}};
    return surface;
  };
  const double traced = 0.8, wanted = 0.6, angle = 0.3;
  for (const auto& make : {std::function<Surface(double)>([&](double r) { return stack(r, 0.0); }),
                           std::function<Surface(double)>([&](double r) { return stack(r, 1.35); }),
                           std::function<Surface(double)>(mixed)}) {
    const Surface surface = make(traced);
    Moments weights;
    std::uint32_t most = 0;
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(4, StreamKind::other, i);
      Ray ray{Vec3(std::sin(angle), 0.0, std::cos(angle)), Vec3::Zero()};
      ReflectionLog log;
      const Incidence incidence{Side::inside, Vec3::UnitZ(), {1.82, 1.0}, 420.0, &log};
      const bool absorbed = surface.interact(ray, incidence, rng) == SurfaceOutcome::absorbed;
      double weight = absorbed ? 0.0 : 1.0;
      for (const ReflectionLog::Entry& entry : log.entries()) {
        CHECK(entry.depth == doctest::Approx(entry.count * -std::log(traced)));
        weight *= std::pow(wanted / traced, entry.count);
        most = std::max(most, entry.count);
      }
      weights.add(weight);
    }
    CHECK(most > 3);  // to and fro under the face, several times in one meeting
    const Estimate absorbed = absorbed_share(make(wanted), angle, Side::inside);
    CHECK(sigmas(weights.mean(), {1.0 - absorbed.value, absorbed.error}) < kSigmas);
  }
}
