// Reweighting against a mirrored rod whose detected fraction has a closed form.
#include "scintray/analysis/reweight.hpp"

#include <doctest/doctest.h>

#include "analysis/toys.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

constexpr double kRod_mm = 20.0, kExit = 0.3;
constexpr std::uint64_t kEmitted = 40'000;

/// Light along a rod between a mirror of reflectance R and a window that lets a share out each time and turns
/// the rest back: out after k round trips with share exit (1 - exit)^k R^k exp(-mu (2 k + 1) length), started
/// at the mirror. The sum over k:
double detected_fraction(double mu, double reflectance) {
  const double once = std::exp(-mu * kRod_mm);
  return kExit * once / (1.0 - (1.0 - kExit) * reflectance * once * once);
}

/// One photon of the rod.
struct RodPhoton {
  float path_mm = 0.0F, absorption_depth = 0.0F;
  std::uint32_t reflections = 0;
  float reflection_depth = 0.0F;
};

struct Rod {
  double mu = 0.0, reflectance = 0.0;
  std::vector<RodPhoton> detected;
};

Rod trace_rod(double mu, double reflectance, std::uint64_t stream) {
  Rod rod{mu, reflectance, {}};
  for (std::uint64_t i = 0; i < kEmitted; ++i) {
    Rng rng = toy_rng(stream, i);
    int turns = 0;
    bool alive = rng.uniform() < std::exp(-mu * kRod_mm);
    for (; alive && rng.uniform() >= kExit; ++turns)
      alive = rng.uniform() < reflectance * std::exp(-2.0 * mu * kRod_mm);
    const double path_mm = (2 * turns + 1) * kRod_mm;
    if (alive)
      rod.detected.push_back({static_cast<float>(path_mm), static_cast<float>(mu * path_mm),
                              static_cast<std::uint32_t>(turns),
                              static_cast<float>(-turns * std::log(reflectance))});
  }
  return rod;
}

constexpr WantedProperty constant(double value) { return {WantedProperty::As::constant, value}; }
constexpr WantedProperty times(double value) { return {WantedProperty::As::times, value}; }

Reweighted reweight(const Rod& rod, std::uint64_t emitted, WantedProperty absorption,
                    WantedProperty reflectance, double cut_share = 0.0) {
  Reweighting reweighting(
      {{{rod.mu, rod.mu}}, {absorption}, {{rod.reflectance, rod.reflectance}}, {reflectance}, {"\"mirror\""}},
      rod.detected.size());
  for (const RodPhoton& photon : rod.detected)
    reweighting.add({std::span(&photon.path_mm, 1), std::span(&photon.absorption_depth, 1),
                     std::span(&photon.reflections, 1), std::span(&photon.reflection_depth, 1)});
  return reweighting.finish(emitted, cut_share);
}

}  // namespace

TEST_CASE("Law: reweighted photons give the fraction of the wanted rod") {
  const double mu = 0.005, reflectance = 0.9;
  const Rod rod = trace_rod(mu, reflectance, 80);
  const Reweighted same = reweight(rod, kEmitted, constant(mu), constant(reflectance));
  CHECK(same.effective_share == doctest::Approx(1.0));
  CHECK(same.relative.value == doctest::Approx(1.0));
  CHECK(sigmas(same.detected_fraction, {detected_fraction(mu, reflectance), 0.0}) < kSigmas);
  for (const double other_mu : {0.0, 0.002, 0.01, 0.03})
    for (const double other_reflectance : {0.7, 0.9, 0.97}) {
      CAPTURE(other_mu);
      CAPTURE(other_reflectance);
      const double expected = detected_fraction(other_mu, other_reflectance);
      const Reweighted other = reweight(rod, kEmitted, constant(other_mu), constant(other_reflectance));
      CHECK(other.valid);
      CHECK(sigmas(other.detected_fraction, {expected, 0.0}) < kSigmas);
      const Reweighted factors =
          reweight(rod, kEmitted, times(other_mu / mu), times(other_reflectance / reflectance));
      CHECK(factors.detected_fraction.value == doctest::Approx(other.detected_fraction.value));
    }
}

TEST_CASE("Pulls of reweighted fractions are normal") {
  Pulls pulls;
  const Rod rod = trace_rod(0.005, 0.9, 81);
  const double truth = reweight(rod, kEmitted, constant(0.002), constant(0.95)).detected_fraction.value;
  // Drawn from the photons of one run, with its own answer as the truth.
  for (std::uint64_t toy = 0; toy < 200; ++toy) {
    Rod drawn{rod.mu, rod.reflectance, {}};
    Rng rng = toy_rng(82, toy);
    for (int i = 0; i < 2000; ++i) {
      const auto pick = static_cast<std::size_t>(static_cast<double>(kEmitted) * rng.uniform());
      if (pick < rod.detected.size()) drawn.detected.push_back(rod.detected[pick]);
    }
    pulls.add(reweight(drawn, 2000, constant(0.002), constant(0.95)).detected_fraction, truth);
  }
  CHECK(sigmas(pulls.mean(), {0.0, 0.0}) < kSigmas);
  CHECK(sigmas(pulls.width(), {1.0, 0.0}) < kSigmas);
}

TEST_CASE("Where the photons that matter are rare or missing the result is not valid") {
  const Rod dark = trace_rod(0.1, 0.5, 83);
  const Reweighted far = reweight(dark, kEmitted, constant(0.0), constant(0.99));
  CHECK_FALSE(far.valid);
  CHECK(far.reason != "");

  // Of 40,000 photons, those of four reflections and more are missing: each would weigh 90^4.
  const Rod black = trace_rod(0.0, 0.01, 84);
  const Reweighted white = reweight(black, kEmitted, constant(0.0), constant(0.9));
  CHECK_FALSE(white.valid);
  // A little of that: no photon has too much of the weight, but one more reflection would.
  check_contains(reweight(black, kEmitted, constant(0.0), constant(0.1)).reason, "one more reflection");

  // Weights exp(mu path) of paths that end at the rate 2 mu have a tail of shape mu / (2 mu).
  const double mu = 0.2;
  Reweighting heavy({{{mu, mu}}, {constant(0.0)}, {}, {}, {}}, 100'000);
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    Rng rng = toy_rng(85, i);
    const auto path = static_cast<float>(sample_exponential(rng) / (2.0 * mu));
    const auto depth = static_cast<float>(mu * static_cast<double>(path));
    heavy.add({std::span(&path, 1), std::span(&depth, 1), {}, {}});
  }
  // Hill's estimate from 948 weights has the error 1/2 / sqrt(948).
  CHECK(std::abs(heavy.finish(1'000'000).tail_shape - 0.5) < kSigmas * 0.5 / std::sqrt(948.0));
  // Less light than when traced has no such tail.
  CHECK(reweight(dark, kEmitted, constant(0.3), constant(0.4)).tail_shape == 0.0);
}

TEST_CASE("Impossible reweighting is refused or not valid") {
  const RodPhoton straight{10.0F, 1.0F, 0, 0.0F};
  const Rod rod{0.1, 0.0, std::vector<RodPhoton>(200, straight)};
  const Reweighted mirror = reweight(rod, 1000, constant(0.1), constant(0.5));
  CHECK_FALSE(mirror.valid);
  check_contains(mirror.reason, "\"mirror\" reflected nothing when traced");
  check_contains(reweight({0.1, 0.5, {}}, 1000, constant(0.1), constant(0.5)).reason, "0 effective photons");
  const Rod grey{0.1, 0.5, rod.detected};
  check_contains(reweight(grey, 1000, constant(0.05), {}, 0.3).reason, "were cut at the limits");
  CHECK(reweight(grey, 1000, constant(0.2), {}, 0.3).valid);  // those cut would have been lost all the more
  CHECK_THROWS_AS(reweight(grey, 100, constant(0.1), {}), std::invalid_argument);
  CHECK_THROWS_AS(reweight(grey, 1000, constant(-0.1), {}), std::invalid_argument);
  CHECK_THROWS_AS(reweight(grey, 1000, {}, constant(1.1)), std::invalid_argument);
  CHECK_THROWS_AS(reweight(grey, 1000, {}, times(2.1)), std::invalid_argument);
  CHECK_THROWS_AS(Reweighting({{{0.1, 0.1}}, {}, {}, {}, {}}, 10), std::invalid_argument);
  Reweighting other({{{0.1, 0.1}}, {constant(0.2)}, {}, {}, {}}, 10);
  CHECK_THROWS_AS(other.add({}), std::invalid_argument);
}
