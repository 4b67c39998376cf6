#include "scintray/core/count_sampling.hpp"

#include <boost/random/binomial_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <limits>

namespace scintray::core {

namespace {

/// A Random stream as the generator that Boost's distributions require.
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
  return static_cast<std::uint64_t>(boost::random::poisson_distribution<std::int64_t>(mean)(bits));
}

std::uint64_t sample_binomial(std::uint64_t trials, double probability, Rng& rng) {
  if (trials == 0 || probability <= 0.0) return 0;
  if (probability >= 1.0) return trials;
  Bits bits{rng};
  return static_cast<std::uint64_t>(boost::random::binomial_distribution<std::int64_t>(
      static_cast<std::int64_t>(trials), probability)(bits));
}

}  // namespace scintray::core
