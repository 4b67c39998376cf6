#include <doctest/doctest.h>

#include "scintray/core/statistics.hpp"
#include "scintray/surface/surface.hpp"

using namespace scintray;

namespace {

constexpr double kSigmas = 4.0;
constexpr std::uint64_t kRays = 200'000;

Estimate absorbed_share(const Surface& surface, double angle, Side side) {
  std::uint64_t absorbed = 0;
  const double z = side == Side::inside ? std::cos(angle) : -std::cos(angle);
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(1, StreamKind::other, i);
    Ray ray{Vec3(std::sin(angle), 0.0, z), Vec3::Zero()};
    absorbed += surface.meet(ray, side, Vec3::UnitZ(), {1.82, 1.0}, 420.0, rng) == SurfaceOutcome::absorbed;
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
  // First meeting 1 - R; each return meets the face with the diffuse reflectance R21 = 0.136763.
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
  CHECK(painted.meet(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, 400.0, rng) == SurfaceOutcome::absorbed);
  CHECK(painted.meet(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, 500.0, rng) == SurfaceOutcome::inside);
}
