// Order statistics of photons, and the bound on timing, against closed forms and simulated emission.
#include <doctest/doctest.h>

#include <limits>

#include "analysis/toys.hpp"
#include "scintray/analysis/event_analysis.hpp"
#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/analysis/timing/detail/photon_time.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::test;
using doctest::Approx;

namespace {

/// Earliest photons of many events under perfect collection.
std::vector<std::vector<double>> emit(std::size_t events, double photons, double decay_ns, double rise_ns,
                                      double jitter_ns, std::uint64_t stream) {
  std::vector<std::vector<double>> all;
  for (std::size_t event = 0; event < events; ++event) {
    Rng rng = toy_rng(stream, event);
    all.push_back(sample_photon_times(photons, decay_ns, rise_ns, jitter_ns, rng));
  }
  return all;
}

std::vector<double> nth(const std::vector<std::vector<double>>& events, std::size_t n) {
  std::vector<double> times;
  for (const std::vector<double>& event : events)
    if (event.size() >= n) times.push_back(event[n - 1]);
  return times;
}

/// Variance with its standard error, for differences that are close to Gaussian.
Estimate variance_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  const double variance = std::pow(moments.standard_deviation(), 2);
  return {variance, variance * std::sqrt(2.0 / static_cast<double>(values.size()))};
}

Estimate mean_time(const std::vector<double>& times) {
  Moments moments;
  for (const double time : times) moments.add(time);
  return moments.mean();
}

}  // namespace

TEST_CASE("Law: with an instantaneous rise the first of N photons comes after decay / N") {
  const double decay = 40.0, photons = 400.0;
  const auto events = emit(4000, photons, decay, 0.0, 0.0, 1);
  const std::vector<double> first = nth(events, 1);
  CHECK(sigmas(mean_time(first), {decay / photons, 0.0}) < kSigmas);
  CHECK(mean_first_photon_ns(PhotonTime({{decay}}, 0.0), 1e8) == Approx(decay / 1e8).epsilon(1e-6));
  // The difference of two such times is a Laplace distribution of scale decay / N, whose quantile q < 1/2 is
  // scale ln(2 q).
  const Spread pairs = spread_of(paired_differences(first));
  const double fwhm = -2.0 * decay / photons * std::log(2.0 * 0.11951572);
  CHECK(sigmas(pairs.quantile_fwhm, {fwhm, 0.0}) < kSigmas);
  // The n-th photon is a sum of n such waiting times, so far as n is small against N.
  CHECK(sigmas(mean_time(nth(events, 3)), {-decay * std::log1p(-3.0 / photons), 0.0}) < kSigmas);
}

TEST_CASE("Law: with a rise time the first of N photons comes after sqrt(pi rise decay / 2 N)") {
  const double decay = 40.0, rise = 0.5;
  const auto closed = [&](double photons) { return std::sqrt(kPi * rise * decay / (2.0 * photons)); };
  const PhotonTime time({{decay, rise}}, 0.0);
  // The next order of the share before t, t^2 / (2 rise decay) (1 - t (1 / rise + 1 / decay) / 3), is a share
  // of the root of 1 / N: a hundred times the photons leave a tenth of the difference.
  const double few = mean_first_photon_ns(time, 1e6) / closed(1e6) - 1.0;
  const double many = mean_first_photon_ns(time, 1e8) / closed(1e8) - 1.0;
  CHECK(std::abs(few) < 0.005);
  CHECK(many == Approx(0.1 * few).epsilon(0.02));
  const auto events = emit(3000, 500.0, decay, rise, 0.0, 2);
  CHECK(sigmas(mean_time(nth(events, 1)), {mean_first_photon_ns(time, 500.0), 0.0}) < kSigmas);
}

TEST_CASE("Density, slope and share before belong together") {
  const PhotonTime time({{40.0, 0.1, 0.8}, {12.0, 0.0, 0.2}}, 0.15);
  for (const double t : {-0.4, -0.1, 0.0, 0.05, 0.3, 2.0, 30.0, 150.0}) {
    CAPTURE(t);
    constexpr double kStep = 1e-4;
    CHECK(time.slope(t) ==
          Approx((time.density(t + kStep) - time.density(t - kStep)) / (2.0 * kStep)).epsilon(1e-4));
    CHECK(time.density(t) ==
          Approx((time.before(t + kStep) - time.before(t - kStep)) / (2.0 * kStep)).epsilon(1e-4));
  }
  CHECK(time.before(time.latest_ns()) == Approx(1.0).epsilon(1e-8));
  CHECK(time.before(time.earliest_ns()) < 1e-9);
  // Rise and decay alike: t exp(-t / tau) / tau^2.
  CHECK(PhotonTime({{3.0, 3.0}}, 0.0).density(2.0) == Approx(2.0 * std::exp(-2.0 / 3.0) / 9.0).epsilon(1e-5));
}

TEST_CASE("Information: closed form, and what belongs to all photons, the first n, and the n-th alone") {
  // Where jitter is all, the density is Gaussian: 1 / sigma^2 a photon.
  CHECK(time_information(PhotonTime({{0.001}}, 0.5), 1.0) == Approx(4.0).epsilon(1e-3));
  const PhotonTime time({{40.0, 0.1}}, 0.1);
  constexpr double kPhotons = 1000.0;
  const double all = time_information(time, kPhotons);
  CHECK(time_information(time, kPhotons, 2000) == Approx(all).epsilon(1e-6));
  // The record up to the first photon is the time of the first photon.
  CHECK(time_information(time, kPhotons, 1) ==
        Approx(time_information_of_photon(time, kPhotons, 1)).epsilon(1e-6));
  double before = 0.0;
  for (const std::size_t n : {1, 2, 5, 10, 30, 100}) {
    CAPTURE(n);
    const double first = time_information(time, kPhotons, n);
    CHECK(first > before);
    CHECK(first <= all);
    CHECK(time_information_of_photon(time, kPhotons, n) <= first * (1.0 + 1e-9));
    before = first;
  }
  CHECK(std::isinf(time_information(PhotonTime({{40.0}}, 0.0), 1.0)));
}

TEST_CASE(
    "Law: CTR of Poisson emission with perfect collection obeys the bound, and the likelihood reaches it") {
  const double decay = 40.0, rise = 0.1, jitter = 0.12;
  const PhotonTime time({{decay, rise}}, jitter);
  const MostLikelyTime estimate(time);
  // Likelihood is efficient in the limit of many photons. Its variance over the bound is 2.7 at 100 photons,
  // 1.19 at 600, 1.05 at 3000; 8 % are allowed on top there.
  const auto bright = emit(800, 3000.0, decay, rise, jitter, 3);
  std::vector<double> likely;
  for (const std::vector<double>& event : bright) likely.push_back(estimate(event));
  const double bright_bound = 2.0 / time_information(time, 3000.0);
  const Estimate reached = variance_of(paired_differences(likely));
  CAPTURE(reached.value / bright_bound);
  CHECK(reached.value > bright_bound - kSigmas * reached.error);
  CHECK(reached.value < 1.08 * bright_bound + kSigmas * reached.error);

  const double photons = 600.0;
  const auto events = emit(1500, photons, decay, rise, jitter, 6);
  const double bound = 2.0 / time_information(time, photons);
  for (const std::size_t n : {1, 3, 10, 30}) {
    CAPTURE(n);
    const Estimate single = variance_of(paired_differences(nth(events, n)));
    const double limit = 2.0 / time_information_of_photon(time, photons, n);
    // One time, of a density that is nearly Gaussian, is nearly as good as its bound.
    CHECK(single.value < 1.25 * limit + kSigmas * single.error);
    CHECK(single.value > limit - kSigmas * single.error);
    CHECK(single.value > bound - kSigmas * single.error);
  }
}

TEST_CASE("The analysis of orders finds the best photon near that of the bound") {
  const double photons = 1000.0;
  const PhotonTime time({{40.0, 0.1}}, 0.12);
  auto events = emit(2000, photons, 40.0, 0.1, 0.12, 4);
  FirstPhotons earliest(40);
  for (std::size_t event = 0; event < events.size(); ++event)
    for (auto it = events[event].rbegin(); it != events[event].rend(); ++it) earliest.add(event, *it);
  const auto kept = earliest.times_ns();
  REQUIRE(kept.size() == events.size());
  for (std::size_t event = 0; event < 20; ++event)
    CHECK(std::equal(kept[event].begin(), kept[event].end(), events[event].begin()));
  const OrderAnalysis analysis = analyze_orders(kept, 40);
  REQUIRE(analysis.single.size() == 40);
  const OrderTiming& best = analysis.single[analysis.best_single];
  std::size_t expected = 1;
  for (std::size_t n = 1; n <= 40; ++n)
    if (time_information_of_photon(time, photons, n) > time_information_of_photon(time, photons, expected))
      expected = n;
  const double bound = coincidence_bound_fwhm_ns(time_information_of_photon(time, photons, expected));
  CAPTURE(best.n);
  CAPTURE(expected);
  CHECK(best.ctr_fwhm_ns.value > bound - kSigmas * best.ctr_fwhm_ns.error);
  CHECK(best.ctr_fwhm_ns.value < 1.15 * bound);
  // The mean of the first n uses more of them than the n-th alone.
  CHECK(analysis.average[analysis.best_average].ctr_fwhm_ns.value < best.ctr_fwhm_ns.value);
  CHECK(analyze_orders(std::vector<std::vector<double>>(20, {0.1}), 5).single.empty());
}

TEST_CASE("The quoted CTR of few and of many events is one quantity, with an error of its own size") {
  // Two-sided exponentials, which no Gaussian describes; 0.1195 of them are below -ln(1 / 0.239).
  constexpr double kTruth = 2.8622;
  constexpr int kSamples = 300;
  core::Rng rng(7, core::StreamKind::other, 1);
  for (const int values : {60, 127, 128, 400, 1000}) {
    CAPTURE(values);
    double squares = 0.0, fitted = 0.0;
    for (int sample = 0; sample < kSamples; ++sample) {
      std::vector<double> differences;
      for (int i = 0; i < values; ++i)
        differences.push_back(core::sample_exponential(rng) - core::sample_exponential(rng));
      const Spread spread = spread_of(differences);
      const core::Estimate quoted = quoted_fwhm(spread);
      squares += std::pow((quoted.value - kTruth) / quoted.error, 2);
      if (spread.fit.converged) fitted += spread.gaussian_fwhm.value / kSamples;
    }
    const double width = std::sqrt(squares / kSamples);
    CAPTURE(width);
    CAPTURE(fitted);
    // The error of a root mean square is 0.04; the error itself is known to 30 % only for 60 values.
    CHECK(std::abs(width - 1.0) < 4 * 0.04 + 0.05);
  }
}

TEST_CASE("Pairs use each event once and leave out events without a time") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(paired_differences(std::vector<double>{1.0, none, 4.0, 9.0, 2.0, 5.0}) ==
        std::vector<double>{-3.0, 7.0});
  CHECK(channel_differences(std::vector<double>{1.0, none, 4.0}, std::vector<double>{0.5, 1.0, none}) ==
        std::vector<double>{0.5});
  CHECK_THROWS_AS(channel_differences(std::vector<double>{1.0}, std::vector<double>{}),
                  std::invalid_argument);
}

TEST_CASE("Timing against depth finds the speed of light in a crystal") {
  Rng rng = toy_rng(5);
  std::vector<double> depths, times;
  const double slope = 1.82 / kSpeedOfLight_mm_per_ns;
  for (int i = 0; i < 8000; ++i) {
    depths.push_back(20.0 * rng.uniform());
    times.push_back(slope * depths.back() + 0.08 * sample_normal(rng));
  }
  const TimingDepth timing = timing_against_depth(depths, times, 5);
  REQUIRE(timing.slices.size() == 5);
  CHECK(sigmas(timing.line.slope, {slope, 0.0}) < kSigmas);
  // Pairs within a slice of 4 mm: its own spread of delays adds to the width.
  const double expected = kFwhmPerSigma * std::sqrt(2.0) * std::hypot(0.08, slope * 4.0 / std::sqrt(12.0));
  for (const TimingSlice& slice : timing.slices) CHECK(sigmas(slice.ctr_fwhm_ns, {expected, 0.0}) < kSigmas);
}

TEST_CASE("Unphysical emission is refused") {
  CHECK(contains(complaint_of([] { PhotonTime({}, 0.1); }), "sum to 0"));
  CHECK(contains(complaint_of([] { PhotonTime({{-1.0}}, 0.1); }), "not positive"));
  CHECK(contains(complaint_of([] { PhotonTime({{40.0, 0.1, 0.5}}, 0.1); }), "expected 1"));
  CHECK(contains(complaint_of([] { PhotonTime({{40.0}}, -0.1); }), "jitter"));
  CHECK(contains(complaint_of([] { MostLikelyTime(PhotonTime({{40.0}}, 0.0)); }), "without jitter"));
  CHECK(contains(complaint_of([] { MostLikelyTime(PhotonTime({{40.0}}, 0.1))({}); }), "without photons"));
}

TEST_CASE(
    "Orders of an event are the earliest of its channels, and means extend as far as all photons are known") {
  const float none = std::numeric_limits<float>::quiet_NaN();
  OrderCollector collector({5, 1, 2});
  EventRecord event;
  event.channels.resize(2);
  event.channels[0].order_ns = {9.0F, 1.0F, 3.0F};
  event.channels[1].order_ns = {none, 2.0F, 1.5F};
  collector.add(event);
  event.channels[0].order_ns = {none, none, none};
  event.channels[1].order_ns = {};
  collector.add(event);
  const std::vector<std::size_t> both{1, 0};
  const std::vector<OrderTimes> times = collector.times(both);
  REQUIRE(times.size() == 3);
  CHECK((times[0].n == 1 && times[1].n == 2 && times[2].n == 5));
  CHECK(times[0].single[1] == 1.0);
  CHECK(times[1].single[1] == 1.5);
  CHECK(times[2].single[1] == 9.0);
  CHECK(times[1].average[1] == 1.75);  // of the second channel; the first one's is 2
  CHECK(times[2].average.empty());
  CHECK(std::isnan(times[0].single[0]));
}

TEST_CASE("Recorded orders have the CTR of their photons, overall and by depth, above the bound") {
  const double photons = 1000.0;
  const LightTiming timing{{{40.0, 0.1, 1.0}}, 0.12};
  const auto events = emit(2000, photons, 40.0, 0.1, 0.12, 4);
  const OrderAnalysis all = analyze_orders(events, 10);
  AnalysisSetup setup;
  setup.channels_mm = {Vec3::Zero()};
  setup.depth = DepthAxis{Vec3::Zero(), Vec3::UnitZ()};
  setup.photon_order = {1, 2, 3, 10};
  setup.light_timing = timing;
  EventCollector collector(setup);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EventRecord event;
    event.event = i;
    event.part = PartId(0);
    event.position_mm = {0.0F, 0.0F, static_cast<float>(i % 20)};
    ChannelRecord channel;
    channel.detected = static_cast<std::uint32_t>(events[i].size());
    channel.charge = static_cast<float>(events[i].size());
    channel.time_ns = channel.first_ns = static_cast<float>(events[i].front());
    for (const std::size_t n : {1, 2, 3, 10})
      channel.order_ns.push_back(static_cast<float>(events[i][n - 1]));
    event.channels = {channel};
    collector.add(event);
  }
  setup.photopeak_only = false;
  const EventAnalysis analysis = collector.finish();
  REQUIRE(analysis.orders);
  REQUIRE(analysis.orders->single.size() == 4);
  CHECK(analysis.orders->average.size() == 3);
  REQUIRE(analysis.orders_bound);
  CHECK(analysis.orders_bound->photons == doctest::Approx(photons).epsilon(0.01));
  CHECK(analysis.orders->single[3].n == 10);
  if (analysis.selected == events.size())
    CHECK(analysis.orders->single[3].ctr_fwhm_ns.value ==
          doctest::Approx(all.single[9].ctr_fwhm_ns.value).epsilon(1e-3));
  for (std::size_t i = 0; i < 4; ++i) {
    const Estimate& ctr = analysis.orders->single[i].ctr_fwhm_ns;
    CHECK(ctr.value > analysis.orders_bound->first_ns[i] - kSigmas * ctr.error);
    CHECK(analysis.orders_bound->first_ns[i] >= analysis.orders_bound->all_ns);
  }
  CHECK(analysis.orders_against_depth.size() == 10);
  CHECK(analysis.depth_bounds.size() == 10);
  CHECK_FALSE(timing_bound({{{40.0, 0.1, 1.0}}, 0.0}, photons, analysis.orders->single));
  CHECK_FALSE(timing_bound(timing, 0.0, analysis.orders->single));
}
