#include "scintray/core/elementary.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "scintray/core/rng.hpp"

using namespace scintray::core;

namespace {

constexpr int kTrials = 200'000;

struct Deviation {
  double sine = 0.0, cosine = 0.0;
  void add(const SineCosine& found, long double angle) {
    sine = std::max(sine, static_cast<double>(std::abs(found.sine - std::sin(angle))));
    cosine = std::max(cosine, static_cast<double>(std::abs(found.cosine - std::cos(angle))));
  }
};

}  // namespace

TEST_CASE("Sine and cosine of a share of a turn are within 2e-16 of those in extended precision") {
  Rng rng(1, StreamKind::other, 1);
  Deviation deviation;
  for (int i = 0; i < kTrials; ++i) {
    const double turns = rng.uniform();
    deviation.add(sincos_of_turn(turns), 2.0L * std::acos(-1.0L) * static_cast<long double>(turns));
  }
  CHECK(deviation.sine < 2e-16);
  CHECK(deviation.cosine < 2e-16);
}

TEST_CASE("Sine and cosine of an angle up to 1000 rad are within 2e-16 of those in extended precision") {
  Rng rng(1, StreamKind::other, 2);
  Deviation deviation;
  for (const double widest : {1.0, 1000.0})
    for (int i = 0; i < kTrials; ++i) {
      const double angle = widest * (2.0 * rng.uniform() - 1.0);
      deviation.add(sincos(angle), angle);
    }
  CHECK(deviation.sine < 2e-16);
  CHECK(deviation.cosine < 2e-16);
}

TEST_CASE("Quarters of a turn are exact") {
  const double sines[] = {0.0, 1.0, 0.0, -1.0, 0.0};
  for (int quarter = 0; quarter <= 4; ++quarter) {
    const SineCosine found = sincos_of_turn(0.25 * quarter);
    CHECK(found.sine == sines[quarter]);
    CHECK(found.cosine == sines[(quarter + 1) % 4]);
  }
}

TEST_CASE("The logarithm is within one unit in the last place of that in extended precision") {
  Rng rng(1, StreamKind::other, 3);
  double worst = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const double x = std::exp(80.0 * rng.uniform() - 40.0);
    const auto exact = static_cast<double>(std::log(static_cast<long double>(x)));
    const double unit = std::nextafter(std::abs(exact), INFINITY) - std::abs(exact);
    worst = std::max(worst, std::abs(scintray::core::log(x) - exact) / unit);
  }
  CHECK(worst <= 1.0);
  CHECK(scintray::core::log(1.0) == 0.0);
}

TEST_CASE("The bits of the elementary functions are the same on every processor") {
  // Sums of the bits of many values, as computed without fused operations.
  std::uint64_t logarithms = 0, sines = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double x = i / 1001.0;
    logarithms += std::bit_cast<std::uint64_t>(scintray::core::log(x));
    sines += std::bit_cast<std::uint64_t>(sincos_of_turn(x).sine);
    sines += std::bit_cast<std::uint64_t>(sincos(10.0 * x).cosine);
  }
  CHECK(logarithms == 9952671198976844848u);
  CHECK(sines == 279944797580813386u);
}
