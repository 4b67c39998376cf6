// Reweighting against a mirrored rod whose detected fraction has a closed form.
#include "scintray/analysis/reweight.hpp"

#include <doctest/doctest.h>

#include "analysis/toys.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
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

std::vector<PhotonHistory> trace_rod(double mu, double reflectance, std::uint64_t stream) {
  std::vector<PhotonHistory> detected;
  for (std::uint64_t i = 0; i < kEmitted; ++i) {
    Rng rng = toy_rng(stream, i);
    PhotonHistory photon{{static_cast<float>(kRod_mm)}, {0}};
    bool alive = rng.uniform() < std::exp(-mu * kRod_mm);
    while (alive && rng.uniform() >= kExit) {
      photon.path_mm[0] += static_cast<float>(2.0 * kRod_mm);
      ++photon.bounces[0];
      alive = rng.uniform() < reflectance * std::exp(-2.0 * mu * kRod_mm);
    }
    if (alive) detected.push_back(photon);
  }
  return detected;
}

}  // namespace

TEST_CASE("Law: reweighted photons give the fraction of the wanted rod") {
  const double mu = 0.005, reflectance = 0.9;
  const std::vector<PhotonHistory> photons = trace_rod(mu, reflectance, 80);
  const auto wanted = [&](double other_mu, double other_reflectance) {
    return reweight(photons, kEmitted, {{mu}, {other_mu}, {reflectance}, {other_reflectance}});
  };
  const Reweighted same = wanted(mu, reflectance);
  CHECK(same.effective_share == doctest::Approx(1.0));
  CHECK(sigmas(same.detected_fraction, {detected_fraction(mu, reflectance), 0.0}) < kSigmas);
  for (const double other_mu : {0.0, 0.002, 0.01, 0.03})
    for (const double other_reflectance : {0.7, 0.9, 0.97}) {
      CAPTURE(other_mu);
      CAPTURE(other_reflectance);
      const Reweighted other = wanted(other_mu, other_reflectance);
      CHECK(other.valid);
      CHECK(sigmas(other.detected_fraction, {detected_fraction(other_mu, other_reflectance), 0.0}) < kSigmas);
    }
}

TEST_CASE("Pulls of reweighted fractions are normal") {
  Pulls pulls;
  const std::vector<PhotonHistory> photons = trace_rod(0.005, 0.9, 81);
  // Drawn from the photons of one run, with its own answer as the truth.
  for (std::uint64_t toy = 0; toy < 200; ++toy) {
    std::vector<PhotonHistory> detected;
    Rng rng = toy_rng(82, toy);
    for (int i = 0; i < 2000; ++i) {
      const auto pick = static_cast<std::size_t>(static_cast<double>(kEmitted) * rng.uniform());
      if (pick < photons.size()) detected.push_back(photons[pick]);
    }
    pulls.add(reweight(detected, 2000, {{0.005}, {0.002}, {0.9}, {0.95}}).detected_fraction,
              reweight(photons, kEmitted, {{0.005}, {0.002}, {0.9}, {0.95}}).detected_fraction.value);
  }
  CHECK(sigmas(pulls.mean(), {0.0, 0.0}) < kSigmas);
  CHECK(sigmas(pulls.width(), {1.0, 0.0}) < kSigmas);
}

TEST_CASE("Where few photons carry the weight the answer is not valid") {
  const std::vector<PhotonHistory> photons = trace_rod(0.1, 0.5, 83);
  const Reweighted far = reweight(photons, kEmitted, {{0.1}, {0.0}, {0.5}, {0.99}});
  CHECK_FALSE(far.valid);
  CHECK(far.reason != "");
}

TEST_CASE("What cannot be reweighted is refused or said") {
  const std::vector<PhotonHistory> photons(200, PhotonHistory{{10.0F}, {0}});
  const Reweighted mirror = reweight(photons, 1000, {{0.1}, {0.1}, {0.0}, {0.5}});
  CHECK_FALSE(mirror.valid);
  check_says(mirror.reason, "reflected nothing when traced");
  check_says(reweight({}, 1000, {{0.1}, {0.1}, {0.5}, {0.5}}).reason, "0 effective photons");
  CHECK_THROWS_AS(reweight(photons, 100, {{0.1}, {0.1}, {0.5}, {0.5}}), std::invalid_argument);
  CHECK_THROWS_AS(reweight(photons, 1000, {{0.1}, {0.1, 0.2}, {0.5}, {0.5}}), std::invalid_argument);
  CHECK_THROWS_AS(reweight(photons, 1000, {{0.1}, {-0.1}, {0.5}, {0.5}}), std::invalid_argument);
  CHECK_THROWS_AS(reweight(photons, 1000, {{}, {}, {0.5}, {0.5}}), std::invalid_argument);
}
