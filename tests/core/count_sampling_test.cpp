#include "scintray/core/count_sampling.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;

// Every bound is p > 6.3e-5: the false-alarm rate of 4 standard errors.

namespace {

constexpr double kLeastP = 6.3e-5;
constexpr int kSamples = 200'000;

/// p-value that `draw` gives whole numbers with these logarithms of probabilities.
double p_value_of(const std::function<std::uint64_t(Rng&)>& draw,
                  const std::function<double(std::uint64_t)>& log_probability, std::uint64_t highest) {
  std::vector<double> expected(highest + 1);
  for (std::uint64_t k = 0; k <= highest; ++k) expected[k] = kSamples * std::exp(log_probability(k));
  std::vector<std::uint64_t> observed(highest + 1);
  Rng rng(2026, StreamKind::other, 11);
  for (int i = 0; i < kSamples; ++i) {
    const std::uint64_t k = draw(rng);
    REQUIRE(k <= highest);
    ++observed[k];
  }
  return chi_square_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("Poisson numbers have their probabilities, at small and large means") {
  for (const double mean : {0.03, 0.7, 5.0, 9.9, 10.1, 80.0, 12'775.0}) {
    CAPTURE(mean);
    const auto log_probability = [&](std::uint64_t k) {
      return static_cast<double>(k) * std::log(mean) - mean - std::lgamma(static_cast<double>(k) + 1.0);
    };
    const auto highest = static_cast<std::uint64_t>(mean + 12.0 * std::sqrt(mean) + 20.0);
    CHECK(p_value_of([&](Rng& rng) { return sample_poisson(mean, rng); }, log_probability, highest) >
          kLeastP);
  }
}

TEST_CASE(
    "Binomial numbers have their probabilities, on both sides of one half and at any number of trials") {
  for (const std::uint64_t trials : {1u, 7u, 40u, 12'775u})
    for (const double probability : {1e-4, 0.08, 0.5, 0.93}) {
      CAPTURE(trials);
      CAPTURE(probability);
      const auto n = static_cast<double>(trials);
      const auto log_probability = [&](std::uint64_t count) {
        const auto k = static_cast<double>(count);
        return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
               k * std::log(probability) + (n - k) * std::log1p(-probability);
      };
      CHECK(p_value_of([&](Rng& rng) { return sample_binomial(trials, probability, rng); }, log_probability,
                       trials) > kLeastP);
    }
}

TEST_CASE("Counts without chance take nothing from the stream") {
  Rng rng(1, StreamKind::other, 12), untouched(1, StreamKind::other, 12);
  CHECK(sample_poisson(0.0, rng) == 0);
  CHECK(sample_poisson(-1.0, rng) == 0);
  CHECK(sample_binomial(0, 0.5, rng) == 0);
  CHECK(sample_binomial(9, 0.0, rng) == 0);
  CHECK(sample_binomial(9, 1.0, rng) == 9);
  CHECK(rng.bits() == untouched.bits());
}
