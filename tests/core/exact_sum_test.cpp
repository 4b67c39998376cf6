#include "scintray/core/exact_sum.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace scintray::core;

namespace {

ExactSum sum_of(const std::vector<double>& addends) {
  ExactSum sum;
  for (const double addend : addends) sum.add(addend);
  return sum;
}

}  // namespace

TEST_CASE("A sum of one double is that double, to the last bit") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(1.0, 2.0);
  std::uniform_int_distribution<int> exponent(-59, 99);
  for (int i = 0; i < 20'000; ++i) {
    const double x = std::ldexp(mantissa(random), exponent(random)) * (i % 2 == 0 ? 1.0 : -1.0);
    ExactSum sum;
    sum.add(x);
    REQUIRE(sum.value() == x);
  }
  CHECK(ExactSum().value() == 0.0);
  CHECK(sum_of({1e-40, -0.0}).value() == 0.0);  // below the last bit
}

TEST_CASE("Sums are exact where sums of doubles are not, and negative ones and differences too") {
  CHECK(sum_of({1e20, 1.0, -1e20}).value() == 1.0);
  CHECK(sum_of({-1e20, 1e-10, 1e20}).value() == 1e-10);
  CHECK(sum_of({-3.5, 1.25}).value() == -2.25);
  CHECK(sum_of({1.0, -1.0}).value() == 0.0);
  // Integers far beyond 2^53 are rounded once, ties to even.
  const double two53 = 9007199254740992.0;
  CHECK(sum_of({two53, 1.0}).value() == two53);
  CHECK(sum_of({two53, 1.0, 0.25}).value() == two53 + 2.0);
  CHECK(sum_of({two53, 3.0}).value() == two53 + 4.0);
  CHECK(sum_of({two53, 1.0, 1.0}).value() == two53 + 2.0);
}

TEST_CASE("The order of addends, and into which parts they are divided, does not change a bit") {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> addends(5000);
  for (double& addend : addends) addend = std::exp(8.0 * normal(random)) * normal(random);
  const ExactSum whole = sum_of(addends);
  for (int turn = 0; turn < 20; ++turn) {
    std::shuffle(addends.begin(), addends.end(), random);
    ExactSum merged;
    for (std::size_t first = 0; first < addends.size();) {
      const std::size_t last = std::min(addends.size(), first + random() % 700 + 1);
      merged.merge(sum_of({addends.begin() + static_cast<std::ptrdiff_t>(first),
                           addends.begin() + static_cast<std::ptrdiff_t>(last)}));
      first = last;
    }
    REQUIRE(merged == whole);
  }
  long double reference = 0.0L;  // 64 bits of mantissa: within 5000 roundings of 2^-64
  for (const double addend : addends) reference += static_cast<long double>(addend);
  CHECK(whole.value() == doctest::Approx(static_cast<double>(reference)).epsilon(1e-12));
  CHECK(ExactSum::from_words(whole.words()) == whole);
}

TEST_CASE("An addend that is no number, or too large, shows in every sum that it is part of") {
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(), 1.3e30, -1.3e30}) {
    ExactSum sum = sum_of({1.0, wrong, 2.0});
    CHECK(std::isnan(sum.value()));
    ExactSum other = sum_of({5.0});
    other.merge(sum);
    other.add(1.0);
    CHECK(std::isnan(other.value()));
  }
  CHECK(sum_of({1.26e30}).value() == 1.26e30);
}
