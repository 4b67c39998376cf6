#pragma once
/// Sampling of numbers of things.

#include <cstdint>

#include "scintray/core/philox.hpp"

namespace scintray {

/// Poisson deviate; 0 for a mean of 0 or below.
std::uint64_t sample_poisson(double mean, Rng& rng);

/// Number of successes in `trials`, each with `probability`; 0 below a probability of 0, all above 1.
std::uint64_t sample_binomial(std::uint64_t trials, double probability, Rng& rng);

}  // namespace scintray
