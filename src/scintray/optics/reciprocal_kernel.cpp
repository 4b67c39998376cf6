#include "scintray/optics/reciprocal_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::optics {

namespace {

constexpr int kPolar = ReciprocalKernel::kPolar, kTurns = ReciprocalKernel::kTurns,
              kStates = ReciprocalKernel::kStates;
constexpr std::size_t kRow = std::size_t{kStates} * kTurns;
constexpr std::size_t kSize = kStates * kRow;

/// Tolerance of the sum of a row of shares in single precision.
constexpr double kRowRounding = 1e-4;

std::size_t at(int from, int to, int turn) {
  return static_cast<std::size_t>(from) * kRow + static_cast<std::size_t>(to * kTurns + turn);
}

/// Weight of a state: n^2 of its side.
double weight(const IndexPair& index, int state) {
  const double n = index.on(state < kPolar ? Side::inside : Side::outside);
  return n * n;
}

/// Flux of each pair, n_a^2 times the share, with the chi-square of pairs against their reverse.
std::vector<double> symmetric_flux(const IndexPair& index, const std::vector<std::uint32_t>& counts,
                                   double rays, ReciprocalKernel::Report& report) {
  std::vector<double> flux(kSize);
  for (int a = 0; a < kStates; ++a)
    for (int b = a; b < kStates; ++b)
      for (int m = 0; m < kTurns; ++m) {
        const double there = weight(index, a) / rays, back = weight(index, b) / rays;
        const double forth = counts[at(a, b, m)], reverse = counts[at(b, a, m)];
        flux[at(a, b, m)] = flux[at(b, a, m)] = 0.5 * (there * forth + back * reverse);
        if (a == b || forth + reverse == 0.0) continue;
        // Under reciprocity, and given their sum N, the pair's counts are binomial in the ratio of the
        // weights: the difference has mean 0 and variance N there back.
        const double difference = there * forth - back * reverse;
        report.chi2 += difference * difference / ((forth + reverse) * there * back);
        ++report.pairs;
      }
  return flux;
}

/// Scales rows and columns alike until every row sums to its weight. Returns the factors.
std::vector<double> balance(std::vector<double>& flux, const IndexPair& index) {
  // Sums over the turns: the scaling does not depend on them.
  std::vector<double> pair(std::size_t{kStates} * kStates);
  for (int a = 0; a < kStates; ++a)
    for (int b = 0; b < kStates; ++b) {
      const auto first = flux.begin() + static_cast<std::ptrdiff_t>(at(a, b, 0));
      pair[static_cast<std::size_t>(a * kStates + b)] = std::accumulate(first, first + kTurns, 0.0);
    }
  std::vector<double> d(kStates, 1.0);
  constexpr int kMostRounds = 10'000;
  constexpr double kBalanced = 1e-12;
  for (int round = 0; round < kMostRounds; ++round) {
    double worst = 0.0;
    std::vector<double> next(d);
    for (int a = 0; a < kStates; ++a) {
      double sum = 0.0;
      for (int b = 0; b < kStates; ++b)
        sum += pair[static_cast<std::size_t>(a * kStates + b)] * d[static_cast<std::size_t>(b)];
      const double wanted = weight(index, a) / (d[static_cast<std::size_t>(a)] * sum);
      worst = std::max(worst, std::abs(wanted - 1.0));
      next[static_cast<std::size_t>(a)] *=
          std::sqrt(wanted);  // the square root prevents the iteration from oscillating
    }
    d = std::move(next);
    if (worst < kBalanced) break;
  }
  for (int a = 0; a < kStates; ++a)
    for (int b = 0; b < kStates; ++b)
      for (int m = 0; m < kTurns; ++m)
        flux[at(a, b, m)] *= d[static_cast<std::size_t>(a)] * d[static_cast<std::size_t>(b)];
  return d;
}

/// n^2 times the diffuse light of a side that leaves on the other.
core::Estimate diffuse_transmission(const IndexPair& index, const std::vector<std::uint32_t>& counts,
                                    double rays, Side side) {
  const int first = side == Side::inside ? 0 : kPolar;
  double through = 0.0;
  for (int a = first; a < first + kPolar; ++a)
    for (int b = 0; b < kStates; ++b)
      if ((b < kPolar) != (a < kPolar))
        for (int m = 0; m < kTurns; ++m) through += counts[at(a, b, m)];
  const core::Estimate share =
      core::binomial_estimate(static_cast<std::uint64_t>(through), static_cast<std::uint64_t>(rays * kPolar));
  const double n2 = weight(index, first);
  return {n2 * share.value, n2 * share.error};
}

}  // namespace

int ReciprocalKernel::state(Side side, double sine2) {
  const int bin = std::clamp(static_cast<int>(sine2 * kPolar), 0, kPolar - 1);
  return side == Side::inside ? bin : kPolar + bin;
}

int ReciprocalKernel::target(int to_state, double turn) {
  return to_state * kTurns + std::clamp(static_cast<int>(turn / core::kPi * kTurns), 0, kTurns - 1);
}

ReciprocalKernel ReciprocalKernel::from_counts(const IndexPair& index,
                                               const std::vector<std::uint32_t>& counts, std::uint64_t rays,
                                               Report& report) {
  if (counts.size() != kSize)
    throw core::InputError({{},
                            "a reciprocal table has " + std::to_string(counts.size()) + " counts; expected " +
                                std::to_string(kSize),
                            ""});
  for (int a = 0; a < kStates; ++a) {
    const std::span row(counts.data() + static_cast<std::size_t>(a) * kRow, kRow);
    const std::uint64_t sum = std::accumulate(row.begin(), row.end(), std::uint64_t{0});
    if (sum != rays || rays == 0)
      throw core::InputError({{},
                              "direction " + std::to_string(a) + " was lit with " + std::to_string(rays) +
                                  " rays, but " + std::to_string(sum) + " left: the surface absorbs",
                              "only a lossless surface is reciprocal in this sense"});
  }
  const double n = static_cast<double>(rays);
  report = {};
  const core::Estimate inside = diffuse_transmission(index, counts, n, Side::inside);
  const core::Estimate outside = diffuse_transmission(index, counts, n, Side::outside);
  report.diffuse_inside = inside.value;
  report.diffuse_inside_error = inside.error;
  report.diffuse_outside = outside.value;
  report.diffuse_outside_error = outside.error;
  std::vector<double> flux = symmetric_flux(index, counts, n, report);
  for (const double d : balance(flux, index))
    report.largest_scaling = std::max(report.largest_scaling, std::abs(d - 1.0));
  std::vector<float> shares(kSize);
  for (std::size_t k = 0; k < kSize; ++k)
    shares[k] = static_cast<float>(flux[k] / weight(index, static_cast<int>(k / kRow)));
  return ReciprocalKernel(std::move(shares));
}

ReciprocalKernel::ReciprocalKernel(std::vector<float> shares) : shares_(std::move(shares)) {
  if (shares_.size() != kSize)
    throw core::InputError({{},
                            "a reciprocal table has " + std::to_string(shares_.size()) +
                                " shares; expected " + std::to_string(kSize),
                            "rebuild the table"});
  cumulative_.resize(kSize);
  for (std::size_t a = 0; a < kStates; ++a) {
    double sum = 0.0;
    for (std::size_t k = a * kRow; k < (a + 1) * kRow; ++k) {
      if (!(shares_[k] >= 0.0f && shares_[k] <= 1.0f))
        throw core::InputError({{},
                                "share " + std::to_string(k) + " of a reciprocal table is " +
                                    std::to_string(shares_[k]) + "; expected 0 to 1",
                                "rebuild the table"});
      cumulative_[k] = sum += shares_[k];
    }
    if (std::abs(sum - 1.0) > kRowRounding)
      throw core::InputError(
          {{},
           "the shares of direction " + std::to_string(a) + " sum to " + std::to_string(sum) + "; expected 1",
           "rebuild the table"});
  }
}

double ReciprocalKernel::reflectance(Side side, double sine2) const {
  const std::size_t row = static_cast<std::size_t>(state(side, sine2)) * kRow;
  const double inside = cumulative_[row + kRow / 2 - 1] / cumulative_[row + kRow - 1];
  return side == Side::inside ? inside : 1.0 - inside;
}

ReciprocalKernel::Sample ReciprocalKernel::sample(Side side, double sine2, core::Rng& rng) const {
  const auto first = cumulative_.begin() + static_cast<std::ptrdiff_t>(state(side, sine2) * kRow);
  const auto last = first + static_cast<std::ptrdiff_t>(kRow);
  const auto found = std::upper_bound(first, last - 1, rng.uniform() * *(last - 1));
  const int target = static_cast<int>(found - first);
  const int to = target / kTurns;
  return {to < kPolar ? Side::inside : Side::outside, (to % kPolar + rng.uniform()) / kPolar,
          core::kPi * (target % kTurns + rng.uniform()) / kTurns};
}

}  // namespace scintray::optics
