#include "scintray/core/sampling.hpp"
#include "scintray/core/normals.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;

// Every statistical bound here is p > 6.3e-5: the false-alarm rate of 4 standard errors.

namespace {

constexpr double kLeastP = 6.3e-5;
constexpr int kSamples = 200000;
constexpr int kBins = 40;

/// p-value that `draw` has the cumulative distribution `cdf`, in bins of equal probability.
double p_value_of(const std::function<double(Rng&)>& draw, const std::function<double(double)>& cdf) {
  Rng rng(2024, StreamKind::other, 1);
  std::vector<std::uint64_t> observed(kBins);
  const std::vector<double> expected(kBins, static_cast<double>(kSamples) / kBins);
  for (int i = 0; i < kSamples; ++i) {
    const double share = std::clamp(cdf(draw(rng)), 0.0, 1.0);
    ++observed[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(share * kBins))];
  }
  return chi_square_test(observed, expected).p_value;
}

double uniform_azimuth(double y, double x) { return (std::atan2(y, x) + kPi) / kTwoPi; }

const auto as_is = [](double share) { return share; };

const Vec3 kSkewAxis = Vec3(0.3, -0.8, -0.52).normalized();

}  // namespace

TEST_CASE("Uniform numbers are uniform and stay in their half-open ranges") {
  CHECK(p_value_of([](Rng& rng) { return rng.uniform(); }, as_is) > kLeastP);
  CHECK(p_value_of([](Rng& rng) { return rng.uniform_positive(); }, as_is) > kLeastP);
  Rng rng(1, StreamKind::other, 2);
  for (int i = 0; i < kSamples; ++i) {
    const double u = rng.uniform(), v = rng.uniform_positive();
    REQUIRE((u >= 0.0 && u < 1.0 && v > 0.0 && v <= 1.0));
  }
}

TEST_CASE("Isotropic directions are uniform in cosine and azimuth about a skew axis") {
  const Frame frame = Frame::about(kSkewAxis);
  const auto local = [&](Rng& rng) { return frame.to_local(sample_isotropic(rng)); };
  CHECK(p_value_of([&](Rng& rng) { return 0.5 * (1.0 + local(rng).z()); }, as_is) > kLeastP);
  const auto azimuth = [&](Rng& rng) {
    const Vec3 d = local(rng);
    return uniform_azimuth(d.y(), d.x());
  };
  CHECK(p_value_of(azimuth, as_is) > kLeastP);
}

TEST_CASE("Lambertian directions have sin^2 of the polar angle uniform, on the normal's side") {
  const Frame frame = Frame::about(kSkewAxis);
  const auto local = [&](Rng& rng) { return frame.to_local(sample_lambertian(kSkewAxis, rng)); };
  const auto sine2 = [&](Rng& rng) {
    const Vec3 d = local(rng);
    return d.z() < 0.0 ? 2.0 : 1.0 - d.z() * d.z();  // a direction behind the face lands in the last bin
  };
  CHECK(p_value_of(sine2, as_is) > kLeastP);
  const auto azimuth = [&](Rng& rng) {
    const Vec3 d = local(rng);
    return uniform_azimuth(d.y(), d.x());
  };
  CHECK(p_value_of(azimuth, as_is) > kLeastP);
}

TEST_CASE("Polarisations are unit vectors across the direction, uniform in azimuth") {
  const Frame frame = Frame::about(kSkewAxis);
  Rng rng(3, StreamKind::other, 3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 e = sample_polarisation(kSkewAxis, rng);
    CHECK(std::abs(e.dot(kSkewAxis)) < 1e-14);
    CHECK(std::abs(e.norm() - 1.0) < 1e-14);
  }
  const auto azimuth = [&](Rng& stream) {
    const Vec3 e = frame.to_local(sample_polarisation(kSkewAxis, stream));
    return uniform_azimuth(e.y(), e.x());
  };
  CHECK(p_value_of(azimuth, as_is) > kLeastP);
}

TEST_CASE("Exponential and normal deviates follow their laws") {
  CHECK(p_value_of(sample_exponential, [](double x) { return -std::expm1(-x); }) > kLeastP);
  CHECK(p_value_of(sample_normal, [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }) > kLeastP);
  // The check itself sees a difference of a few per cent.
  CHECK(p_value_of([](Rng& rng) { return 1.03 * sample_exponential(rng); },
                   [](double x) { return -std::expm1(-x); }) < kLeastP);
}

TEST_CASE("Frames are right-handed and orthonormal for every axis, the poles too") {
  Rng rng(5, StreamKind::other, 4);
  std::vector<Vec3> axes{Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1e-9, 0, -1).normalized(), Vec3(1, 0, 0)};
  for (int i = 0; i < 1000; ++i) axes.push_back(sample_isotropic(rng));
  for (const Vec3& axis : axes) {
    const Frame frame = Frame::about(axis);
    CHECK((frame.x.cross(frame.y) - frame.z).norm() < 1e-13);
    CHECK(std::abs(frame.x.norm() - 1.0) < 1e-13);
    const Vec3 v(0.1, 0.2, 0.3);
    CHECK((frame.to_world(frame.to_local(v)) - v).norm() < 1e-13);
  }
}

TEST_CASE("the two of a pair of normal deviates have the variance of one and are not correlated") {
  Rng rng(3, StreamKind::other, 6);
  constexpr int kPairs = 100'000;
  double first = 0.0, second = 0.0, first2 = 0.0, second2 = 0.0, both = 0.0, fourths = 0.0;
  for (int i = 0; i < kPairs; ++i) {
    const auto [a, b] = sample_normal_pair(rng);
    first += a, second += b, first2 += a * a, second2 += b * b, both += a * b, fourths += a * a * b * b;
  }
  // Standard errors of the means of a, a^2 - 1, a b and a^2 b^2 - 1 are the roots of 1, 2, 1 and 8 over the
  // number.
  const double error = std::sqrt(1.0 / kPairs);
  CHECK(std::abs(first / kPairs) < 4.0 * error);
  CHECK(std::abs(second / kPairs) < 4.0 * error);
  CHECK(std::abs(first2 / kPairs - 1.0) < 4.0 * std::sqrt(2.0) * error);
  CHECK(std::abs(second2 / kPairs - 1.0) < 4.0 * std::sqrt(2.0) * error);
  CHECK(std::abs(both / kPairs) < 4.0 * error);
  CHECK(std::abs(fourths / kPairs - 1.0) < 4.0 * std::sqrt(8.0) * error);
}

TEST_CASE("many normal deviates at once are those drawn in pairs, to the last bit") {
  for (const int width : lane_widths()) {
    CAPTURE(width);
    for (int drawn = 0; drawn < 9; ++drawn) {  // before, so that blocks are begun
      CAPTURE(drawn);
      for (const std::size_t size : {0, 1, 2, 31, 32, 33, 63, 64, 65, 66, 550}) {
        CAPTURE(size);
        Rng together(3, StreamKind::sensor, 4, size), alone = together;
        for (int i = 0; i < drawn; ++i) CHECK(together.bits() == alone.bits());
        std::vector<double> deviates(size);
        sample_normals(together, deviates, width);
        for (std::size_t i = 0; i < size; i += 2) {
          const auto [first, second] = sample_normal_pair(alone);
          CHECK(deviates[i] == first);
          if (i + 1 < size) CHECK(deviates[i + 1] == second);
        }
        for (int i = 0; i < 9; ++i) CHECK(together.bits() == alone.bits());
      }
    }
  }
}
