#include "scintray/analysis/ratio.hpp"

#include <doctest/doctest.h>

#include "scintray/core/sampling.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;

TEST_CASE("A ratio of sums is their ratio, with the error that repetitions show") {
  // Light 3 per keV with a Poisson-like spread, energies of a wide spectrum. 2000 repetitions: the mean of
  // the squared pull is 1 within sqrt(2 / 2000), and 4 of these errors are a false alarm once in 16,000.
  constexpr int kRepetitions = 2000, kEvents = 200;
  Rng rng(5, StreamKind::other, 1);
  double squared_pulls = 0.0, sum = 0.0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    RatioOfSums ratio;
    for (int i = 0; i < kEvents; ++i) {
      const double energy = 100.0 + 400.0 * rng.uniform();
      ratio.add(energy, 3.0 * energy + std::sqrt(3.0 * energy) * sample_normal(rng));
    }
    const double pull = (ratio.ratio().value - 3.0) / ratio.ratio().error;
    squared_pulls += pull * pull;
    sum += pull;
  }
  // The error is itself estimated from 200 events: 1 / 200 more on the mean square.
  CHECK(std::abs(squared_pulls / kRepetitions - 1.0) < 4.0 * std::sqrt(2.0 / kRepetitions) + 2.0 / kEvents);
  CHECK(std::abs(sum / kRepetitions) < 4.0 / std::sqrt(kRepetitions));
}

TEST_CASE("A ratio without enough pairs has no error") {
  RatioOfSums ratio;
  CHECK(ratio.ratio().value == 0.0);
  ratio.add(2.0, 3.0);
  CHECK(ratio.ratio().value == 1.5);
  CHECK(ratio.ratio().error == 0.0);
  ratio.add(4.0, 6.0);
  CHECK(ratio.ratio().error == doctest::Approx(0.0));
}
