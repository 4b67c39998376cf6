// Histograms, and fits of peaks whose truth is known.
#include "scintray/analysis/spectrum/photopeak.hpp"

#include <doctest/doctest.h>

#include "analysis/toys.hpp"
#include "scintray/analysis/spectrum/spread.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;
using doctest::Approx;

namespace {

/// Full-energy events at 511 +- sigma, and events that lost up to `reach` of it on their way.
std::vector<double> pulses(int peak, double sigma, int shoulder, double reach, Rng& rng) {
  std::vector<double> values;
  for (int i = 0; i < peak; ++i) values.push_back(511.0 + sigma * sample_normal(rng));
  for (int i = 0; i < shoulder; ++i)
    values.push_back(511.0 - reach * rng.uniform() + sigma * sample_normal(rng));
  return values;
}

void check_pulls(const Pulls& pulls) {
  CHECK(sigmas(pulls.mean(), {0.0, 0.0}) < kSigmas);
  CHECK(sigmas(pulls.width(), {1.0, 0.0}) < kSigmas);
}

}  // namespace

TEST_CASE("Whole numbers get bins without a comb") {
  Rng rng = toy_rng(1);
  std::vector<double> values;
  for (int i = 0; i < 4000; ++i) values.push_back(sample_poisson(80.0, rng));
  const auto histogram = automatic_histogram(values);
  REQUIRE(histogram);
  CHECK(histogram->width == std::round(histogram->width));
  CHECK(histogram->low - std::floor(histogram->low) == 0.5);
  CHECK(histogram->total() + histogram->below + histogram->above == 4000.0);
  CHECK_FALSE(automatic_histogram(std::vector<double>{3.0, 3.0, 3.0}));
  CHECK_FALSE(automatic_histogram(std::vector<double>{}));
}

TEST_CASE("One far value does not stretch an automatic histogram") {
  Rng rng = toy_rng(2);
  std::vector<double> values{1e9};
  for (int i = 0; i < 2000; ++i) values.push_back(10.0 + sample_normal(rng));
  const auto histogram = automatic_histogram(values);
  REQUIRE(histogram);
  CHECK(histogram->high() < 20.0);
  CHECK(histogram->above == 1.0);
  CHECK(histogram->counts.size() > 20);
}

// 300 toys: the mean pull is known to 0.058 and its width to 0.041; each comparison at 4 sigma raises a false
// alarm once in 15,800.
TEST_CASE("Pulls of a pure Gaussian peak are normal, and a shoulder is seldom preferred") {
  Pulls position, sigma, resolution;
  int with_background = 0, refused = 0;
  Moments p_values;
  for (std::uint64_t toy = 0; toy < 300; ++toy) {
    Rng rng = toy_rng(3, toy);
    const Photopeak peak = fit_photopeak(pulses(2000, 25.0, 0, 0.0, rng));
    if (peak.status != PeakStatus::trusted) ++refused;
    REQUIRE(peak.has_numbers());
    position.add(peak.fit.position, 511.0);
    sigma.add(peak.fit.sigma, 25.0);
    resolution.add(peak.fit.relative_fwhm, kFwhmPerSigma * 25.0 / 511.0);
    if (peak.fit.background != PeakBackground::none) ++with_background;
    p_values.add(peak.fit.goodness.p_value);
  }
  check_pulls(position);
  check_pulls(sigma);
  check_pulls(resolution);
  CHECK(refused == 0);
  // A shoulder has more weight than none where twice the log likelihood ratio is above ln 2000: by chance,
  // with a height that cannot be negative, in 0.3 % (S. S. Wilks 1938, Ann. Math. Statist. 9, 60); 7 of 300
  // once in 30,000.
  CHECK(with_background < 7);
  // Uniform: mean 1/2, standard deviation 1/sqrt(12).
  CHECK(std::abs(p_values.mean().value - 0.5) < kSigmas / std::sqrt(12.0 * 300.0));
}

TEST_CASE("Pulls of a Gaussian on a shoulder are normal") {
  Pulls position, sigma;
  int refused = 0;
  for (std::uint64_t toy = 0; toy < 300; ++toy) {
    Rng rng = toy_rng(4, toy);
    // A shoulder of 1500 counts over 250 keV, and a continuum below 340 keV higher than the peak.
    std::vector<double> values = pulses(2000, 20.0, 1500, 250.0, rng);
    for (int i = 0; i < 6000; ++i) values.push_back(340.0 * rng.uniform());
    const Photopeak peak = fit_photopeak(values);
    REQUIRE(peak.has_numbers());
    if (peak.status != PeakStatus::trusted) ++refused;
    CHECK(peak.fit.background != PeakBackground::none);
    position.add(peak.fit.position, 511.0);
    sigma.add(peak.fit.sigma, 20.0);
  }
  check_pulls(position);
  check_pulls(sigma);
  CHECK(refused == 0);
}

TEST_CASE("A width that few pulses leave uncertain is not trusted; pulls of the others are normal") {
  // Spectra of the crystals of tools/lib/pulls/sipm.toml: a wide peak, and a few pulses of less energy.
  std::vector<Photopeak> trusted;
  int uncertain = 0, without = 0;
  double largest = 0.0;
  for (std::uint64_t toy = 0; toy < 300; ++toy) {
    Rng rng = toy_rng(14, toy);
    std::vector<double> values = pulses(220, 160.0, 60, 400.0, rng);
    std::erase_if(values, [](double value) { return value <= 0.0; });
    const Photopeak peak = fit_photopeak(values);
    if (!peak.has_numbers()) {
      ++without;
      continue;
    }
    CHECK(peak.locates_peak());
    if (peak.status == PeakStatus::trusted) {
      trusted.push_back(peak);
      largest = std::max(largest, peak.fit.sigma.error / peak.fit.sigma.value);
      continue;
    }
    ++uncertain;
    CHECK(peak.status == PeakStatus::uncertain_width);
    CHECK(contains(peak.reason, "cannot be distinguished"));
    CHECK(peak.fit.sigma.error > 0.125 * peak.fit.sigma.value);
  }
  CHECK(uncertain > 10);
  CHECK(uncertain < 100);
  CHECK(without < 10);
  CHECK(largest <= 0.125);
  double sigma = 0.0, resolution = 0.0;
  for (const Photopeak& peak : trusted) {
    sigma += peak.fit.sigma.value / static_cast<double>(trusted.size());
    resolution += peak.fit.relative_fwhm.value / static_cast<double>(trusted.size());
  }
  Pulls of_sigma, of_resolution;
  for (const Photopeak& peak : trusted) {
    of_sigma.add(peak.fit.sigma, sigma);
    of_resolution.add(peak.fit.relative_fwhm, resolution);
  }
  check_pulls(of_sigma);
  check_pulls(of_resolution);
}

TEST_CASE("A shoulder that is left out pulls the peak down: the fit distinguishes the models") {
  Rng rng = toy_rng(5);
  const std::vector<double> values = pulses(20'000, 25.0, 20'000, 250.0, rng);
  PhotopeakOptions bare;
  bare.background = PeakBackground::none;
  const Photopeak wrong = fit_photopeak(values, bare);
  CHECK(wrong.status == PeakStatus::poor_fit);
  CHECK(contains(wrong.reason, "chi-square"));
  CHECK(sigmas(wrong.fit.position, {511.0, 0.0}) > 8.0);
  const Photopeak right = fit_photopeak(values);
  CHECK(right.status == PeakStatus::trusted);
  CHECK(sigmas(right.fit.position, {511.0, 0.0}) < kSigmas);
}

TEST_CASE("Many pulses show a small difference from the model, which still locates the peak") {
  Rng rng = toy_rng(12);
  std::vector<double> values;
  // Two crystals whose light differs by a sigma: wider than either, and flatter than a Gaussian.
  for (int i = 0; i < 300'000; ++i)
    values.push_back((i % 2 == 0 ? 490.0 : 525.0) + 20.0 * sample_normal(rng));
  const Photopeak many = fit_photopeak(values);
  CHECK(many.status == PeakStatus::poor_fit);
  CHECK(many.misfit() > 0.0);
  CHECK(many.locates_peak());
  CHECK(many.fit.position.value == Approx(507.5).epsilon(0.01));
  values.resize(1500);
  CHECK(fit_photopeak(values).status == PeakStatus::trusted);
  // A falling continuum has no peak to locate, however many pulses.
  values.clear();
  for (int i = 0; i < 100'000; ++i) values.push_back(100.0 * sample_exponential(rng));
  CHECK_FALSE(fit_photopeak(values).locates_peak());
}

TEST_CASE("Numbers of photons have the resolution of their Poisson law") {
  Rng rng = toy_rng(6);
  std::vector<double> values;
  for (int i = 0; i < 5000; ++i) values.push_back(sample_poisson(400.0, rng));
  const Photopeak peak = fit_photopeak(values);
  CHECK(peak.status == PeakStatus::trusted);
  CHECK(sigmas(peak.fit.position, {400.0, 0.0}) < kSigmas);
  CHECK(sigmas(peak.fit.relative_fwhm, {kFwhmPerSigma / std::sqrt(400.0), 0.0}) < kSigmas);
}

TEST_CASE("Resolutions from 1 to 40 % are found in one spectrum of any scale") {
  for (const double sigma : {2.0, 10.0, 40.0, 85.0}) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
      CAPTURE(sigma);
      CAPTURE(scale);
      Rng rng = toy_rng(7, static_cast<std::uint64_t>(sigma));
      std::vector<double> values = pulses(4000, sigma, 0, 0.0, rng);
      for (double& value : values) value *= scale;
      const Photopeak peak = fit_photopeak(values);
      CHECK(peak.status == PeakStatus::trusted);
      CHECK(sigmas(peak.fit.sigma, {scale * sigma, 0.0}) < kSigmas);
    }
  }
}

TEST_CASE("A window chooses among peaks") {
  Rng rng = toy_rng(8);
  std::vector<double> values = pulses(4000, 20.0, 0, 0.0, rng);
  for (int i = 0; i < 4000; ++i) values.push_back(202.0 + 15.0 * sample_normal(rng));
  CHECK(sigmas(fit_photopeak(values).fit.position, {511.0, 0.0}) < kSigmas);
  PhotopeakOptions options;
  options.window = {100.0, 300.0};
  CHECK(sigmas(fit_photopeak(values, options).fit.position, {202.0, 0.0}) < kSigmas);
}

TEST_CASE("A fit that cannot be trusted has a status") {
  Rng rng = toy_rng(9);
  SUBCASE("too few") {
    const Photopeak peak = fit_photopeak(pulses(60, 25.0, 0, 0.0, rng));
    CHECK(peak.status == PeakStatus::too_few);
    CHECK(contains(peak.reason, "60 pulses"));
    CHECK_FALSE(peak.has_numbers());
  }
  SUBCASE("all equal") {
    const Photopeak peak = fit_photopeak(std::vector<double>(500, 3.0));
    CHECK(peak.status == PeakStatus::no_peak);
    CHECK(contains(peak.reason, "equal"));
  }
  SUBCASE("cut off above, by saturation or a window") {
    std::vector<double> values = pulses(5000, 25.0, 0, 0.0, rng);
    std::erase_if(values, [](double value) { return value > 520.0; });
    const Photopeak peak = fit_photopeak(values);
    CHECK(peak.status == PeakStatus::edge_of_range);
    check_contains(peak.reason, "the data end at 5");
  }
  SUBCASE("a falling continuum") {
    std::vector<double> values;
    for (int i = 0; i < 5000; ++i) values.push_back(100.0 * sample_exponential(rng));
    CHECK(fit_photopeak(values).status != PeakStatus::trusted);
  }
  SUBCASE("flat") {
    std::vector<double> values;
    for (int i = 0; i < 20'000; ++i) values.push_back(rng.uniform());
    CHECK(fit_photopeak(values).status != PeakStatus::trusted);
  }
  SUBCASE("two peaks that merge") {
    std::vector<double> values = pulses(20'000, 20.0, 0, 0.0, rng);
    for (int i = 0; i < 20'000; ++i) values.push_back(551.0 + 20.0 * sample_normal(rng));
    CHECK(fit_photopeak(values).status != PeakStatus::trusted);
  }
  SUBCASE("no values at all, or none that is finite") {
    CHECK(fit_photopeak({}).status == PeakStatus::too_few);
    CHECK(fit_photopeak(std::vector<double>(200, std::nan(""))).status == PeakStatus::too_few);
  }
}

TEST_CASE("Spread: pulls of both widths and of the mean are normal") {
  Pulls mean, gaussian, quantile;
  for (std::uint64_t toy = 0; toy < 300; ++toy) {
    Rng rng = toy_rng(10, toy);
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i) values.push_back(-0.3 + 0.1 * sample_normal(rng));
    const Spread spread = spread_of(values);
    REQUIRE(spread.fit.converged);
    mean.add(spread.mean, -0.3);
    gaussian.add(spread.gaussian_fwhm, 0.1 * kFwhmPerSigma);
    quantile.add(spread.quantile_fwhm, 0.1 * kFwhmPerSigma);
  }
  check_pulls(mean);
  check_pulls(gaussian);
  check_pulls(quantile);
}

TEST_CASE("Spread: pulls of both widths are normal where no Gaussian describes the values") {
  std::vector<Spread> toys;
  double mean_fwhm = 0.0;
  constexpr std::uint64_t kToys = 300;
  for (std::uint64_t toy = 0; toy < kToys; ++toy) {
    Rng rng = toy_rng(21, toy);
    std::vector<double> values;  // Laplace's distribution
    for (int i = 0; i < 1000; ++i)
      values.push_back((rng.uniform() < 0.5 ? -1.0 : 1.0) * sample_exponential(rng));
    toys.push_back(spread_of(values));
    REQUIRE(toys.back().fit.converged);
    mean_fwhm += toys.back().gaussian_fwhm.value / kToys;
  }
  Pulls gaussian, quantile;
  for (const Spread& toy : toys) {
    gaussian.add(toy.gaussian_fwhm, mean_fwhm);
    quantile.add(toy.quantile_fwhm, 2.0 * std::log(0.5 / 0.11951572));
  }
  check_pulls(gaussian);
  check_pulls(quantile);
}

TEST_CASE("Quantiles do not depend on tails") {
  Rng rng = toy_rng(11);
  std::vector<double> values;
  for (int i = 0; i < 20'000; ++i) values.push_back(sample_normal(rng));
  const Spread clean = spread_of(values);
  for (int i = 0; i < 100; ++i) values.push_back(50.0 * sample_normal(rng));
  const Spread tailed = spread_of(values);
  CHECK(tailed.quantile_fwhm.value == Approx(clean.quantile_fwhm.value).epsilon(0.02));
  CHECK(tailed.gaussian_fwhm.value == Approx(clean.gaussian_fwhm.value).epsilon(0.02));
  CHECK(spread_of({}).count == 0);
  CHECK(spread_of(std::vector<double>(70, 2.0)).quantile_fwhm.value == 0.0);
}
