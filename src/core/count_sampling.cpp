#include "scintray/core/count_sampling.hpp"

#include <limits>
#include <random>

namespace scintray {

namespace {

/// A stream of ours as the standard library's distributions want it.
struct Bits {
  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return rng.bits(); }
  Rng& rng;
};

}  // namespace

std::uint64_t sample_poisson(double mean, Rng& rng) {
  if (mean <= 0.0) return 0;
  Bits bits{rng};
  return std::poisson_distribution<std::uint64_t>(mean)(bits);
}

std::uint64_t sample_binomial(std::uint64_t trials, double probability, Rng& rng) {
  if (trials == 0 || probability <= 0.0) return 0;
  if (probability >= 1.0) return trials;
  Bits bits{rng};
  return std::binomial_distribution<std::uint64_t>(trials, probability)(bits);
}

}  // namespace scintray
