#pragma once
/// Sampling of counts, by Boost.Random: the same counts from the same stream on every platform, by
/// transformed rejection (W. Hormann 1993, J. Stat. Comput. Simul. 46, 101, and Insur. Math. Econ. 12, 39),
/// whose setup is cheap when every count has another mean.

#include <cstdint>

#include "scintray/core/rng.hpp"

namespace scintray::core {

/// Poisson deviate; 0 for a mean of 0 or below.
std::uint64_t sample_poisson(double mean, Rng& rng);

/// Number of successes in `trials`, each with `probability`; 0 below a probability of 0, all above 1.
std::uint64_t sample_binomial(std::uint64_t trials, double probability, Rng& rng);

}  // namespace scintray::core
