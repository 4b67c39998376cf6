// The coincidence timing of Poisson emission with perfect collection against the bound, for
// docs/validation.md.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "analysis/toys.hpp"
#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/analysis/timing/detail/photon_time.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

/// FWHM of a Gaussian with the standard deviation of paired differences, ps. The error takes the differences
/// for Gaussian, which those of the likelihood are at many photons and those of single photons nearly.
Estimate pair_fwhm_ps(const std::vector<double>& times_ns) {
  Moments moments;
  for (const double difference : paired_differences(times_ns)) moments.add(difference);
  const double fwhm = 1e3 * kFwhmPerSigma * moments.standard_deviation();
  return {fwhm, fwhm / std::sqrt(2.0 * static_cast<double>(moments.count))};
}

std::string text(const Estimate& estimate) {
  return fmt::format("{:.1f} ± {:.1f}", estimate.value, estimate.error);
}

}  // namespace

TEST_CASE(
    "CTR of Poisson emission with perfect collection approaches the bound from above with many photons") {
  // Decay 40 ns, rise 0.1 ns, jitter of single photons 0.12 ns (one sigma).
  const PhotonTime time({{40.0, 0.1}}, 0.12);
  const MostLikelyTime most_likely(time);
  constexpr std::size_t kOrder = 10;
  double last_excess = 10.0;
  for (const double photons : {100.0, 600.0, 3000.0, 10'000.0}) {
    constexpr std::size_t kEvents = 1600;
    std::vector<double> likely, first, tenth;
    for (std::size_t event = 0; event < kEvents; ++event) {
      Rng rng = toy_rng(90, event);
      const std::vector<double> times = sample_photon_times(photons, 40.0, 0.1, 0.12, rng);
      likely.push_back(most_likely(times));
      first.push_back(times.front());
      tenth.push_back(times[kOrder - 1]);
    }
    const double bound = 1e3 * coincidence_bound_fwhm_ns(time_information(time, photons));
    const double first_bound = 1e3 * coincidence_bound_fwhm_ns(time_information_of_photon(time, photons, 1));
    const double tenth_bound =
        1e3 * coincidence_bound_fwhm_ns(time_information_of_photon(time, photons, kOrder));
    const Estimate by_likelihood = pair_fwhm_ps(likely), by_first = pair_fwhm_ps(first),
                   by_tenth = pair_fwhm_ps(tenth);
    CAPTURE(photons);
    CHECK(by_likelihood.value > bound - kSigmas * by_likelihood.error);
    CHECK(by_first.value > first_bound - kSigmas * by_first.error);
    CHECK(by_tenth.value > tenth_bound - kSigmas * by_tenth.error);
    // The excess over the bound falls with the number of photons, by far more than its error each time but
    // the last.
    const double excess = by_likelihood.value / bound - 1.0, error = by_likelihood.error / bound;
    CHECK(excess < last_excess + kSigmas * error);
    if (photons >= 3000.0) CHECK(excess < 0.05 + kSigmas * error);
    last_excess = excess;
    evidence("timing_bound", {fmt::format("{:.0f}", photons), fmt::format("{:.1f}", bound),
                              text(by_likelihood), fmt::format("{:.1f}", first_bound), text(by_first),
                              fmt::format("{:.1f}", tenth_bound), text(by_tenth)});
  }
}
