// Fits of noisy curves: toys of known truth, bounds, what data do not determine, wrong input.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/toys.hpp"
#include "scintray/analysis/fit/curve_fit.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

constexpr std::size_t kToyParts = 20;

/// Light lost exponentially with depth: each photon is detected where its own number is below the law.
class ToyDetector {
 public:
  using Law = std::function<double(double x, const std::vector<double>& parameters)>;

  ToyDetector(std::vector<double> x, std::size_t photons, std::uint64_t seed, Law law)
      : x_(std::move(x)), photons_(photons), seed_(seed), law_(std::move(law)) {}

  ModelCurve trace(const std::vector<double>& parameters, std::uint64_t draw) const {
    ModelCurve curve;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double law = law_(x_[i], parameters);
      std::uint64_t detected = 0;
      ModelPoint point;
      for (const auto& part : numbers(draw * x_.size() + i)) {
        const auto n = std::lower_bound(part.begin(), part.end(), law) - part.begin();
        detected += static_cast<std::uint64_t>(n);
        point.parts.push_back(static_cast<double>(n) / static_cast<double>(part.size()));
      }
      point.value = binomial_estimate(detected, photons_);
      curve.push_back(std::move(point));
    }
    return curve;
  }

  CurveModel model() const {
    return
        [this](const std::vector<double>& parameters, std::uint64_t draw) { return trace(parameters, draw); };
  }

 private:
  /// Numbers of the photons of each part, in ascending order.
  using Numbers = std::vector<std::vector<double>>;

  /// Those of one draw and point, made when they are first used.
  const Numbers& numbers(std::size_t draw_and_point) const {
    Numbers& parts = numbers_[draw_and_point];
    if (!parts.empty()) return parts;
    parts.resize(kToyParts);
    Rng rng = toy_rng(seed_, 1000 + draw_and_point);
    for (std::size_t k = 0; k < photons_; ++k) parts[k % kToyParts].push_back(rng.uniform());
    for (auto& part : parts) std::sort(part.begin(), part.end());
    return parts;
  }

  std::vector<double> x_;
  std::size_t photons_;
  std::uint64_t seed_;
  Law law_;
  mutable std::map<std::size_t, Numbers> numbers_;
};

const std::vector<double> kDepths{1, 3, 5, 8, 11, 14, 17, 20};

double falling(double x, const std::vector<double>& p) { return p[0] * std::exp(-x / p[1]); }
/// A shape that a scale leaves two parameters of.
double levelling(double x, const std::vector<double>& p) {
  return 0.8 * ((1.0 - p[0]) * std::exp(-x / p[1]) + p[0]);
}

MeasuredCurve measured_curve(const ToyDetector::Law& law, const std::vector<double>& truth, double scale,
                             double error, std::uint64_t seed, const std::vector<double>& depths = kDepths) {
  MeasuredCurve curve;
  curve.has_errors = true;
  Rng rng = toy_rng(seed, 7);
  for (const double x : depths)
    curve.points.push_back({x, {scale * (law(x, truth) + error * sample_normal(rng)), scale * error}, {}});
  return curve;
}

const std::vector<FitParameter> kFalling{{"amplitude", 0.4, 0.05, 1.0}, {"length", 25.0, 3.0, 60.0}};

}  // namespace

TEST_CASE("Errors of fitted parameters are right: pulls of 300 toys have mean 0 and width 1") {
  const std::vector<double> truth{0.6, 12.0};
  Pulls amplitude, length;
  Moments chi2, converged;
  constexpr int kToys = 300;
  for (int toy = 0; toy < kToys; ++toy) {
    const auto seed = static_cast<std::uint64_t>(toy);
    // Errors of the measurement and of the simulation are alike, so that both must be counted.
    const ToyDetector detector(kDepths, 2000, seed, falling);
    const CurveFit fit =
        fit_curve(measured_curve(falling, truth, 1.0, 0.01, seed), kFalling, detector.model());
    REQUIRE(fit.has_errors);
    amplitude.add(fit.parameters[0].value, truth[0]);
    length.add(fit.parameters[1].value, truth[1]);
    chi2.add(fit.goodness.chi2);
    converged.add(fit.end == FitEnd::converged ? 1.0 : 0.0);
    CHECK(fit.parameters[0].monte_carlo_error < fit.parameters[0].value.error);
  }
  CHECK(converged.mean().value > 0.98);
  for (const Pulls* pulls : {&amplitude, &length}) {
    CHECK(std::abs(pulls->mean().value) < kSigmas * pulls->mean().error);
    CHECK(std::abs(pulls->width().value - 1.0) < kSigmas * pulls->width().error);
  }
  // A chi-square of six degrees of freedom has a mean of 6 and a variance of 12.
  CHECK(std::abs(chi2.mean().value - 6.0) < kSigmas * std::sqrt(12.0 / kToys));
}

TEST_CASE(
    "Of a length that is known to a third, the inverse has pulls of mean 0 and width 1, the length not") {
  const std::vector<double> truth{0.6, 40.0};
  const auto parameters = [](FitVariable variable) {
    return std::vector<FitParameter>{{"amplitude", 0.4, 0.05, 1.0}, {"length", 60.0, 5.0, 1000.0, variable}};
  };
  constexpr int kToys = 300;
  Pulls amplitude, inverse, length;
  Moments covered;
  for (int toy = 0; toy < kToys; ++toy) {
    const auto seed = static_cast<std::uint64_t>(toy);
    const ToyDetector detector(kDepths, 2000, seed, falling);
    const MeasuredCurve measured = measured_curve(falling, truth, 1.0, 0.06, seed);
    const CurveFit fit = fit_curve(measured, parameters(FitVariable::inverse), detector.model());
    REQUIRE(fit.has_errors);
    const FittedParameter& found = fit.parameters[1];
    CHECK(found.variable.value == doctest::Approx(1.0 / found.value.value));
    CHECK(found.value.error == doctest::Approx(found.variable.error * found.value.value * found.value.value));
    CHECK(found.interval_low <= found.value.value);
    CHECK(found.value.value <= found.interval_high);
    CHECK(found.interval_high <= 1000.0);
    CHECK(fit.correlation(0, 1) < 0.0);  // as of the length
    amplitude.add(fit.parameters[0].value, truth[0]);
    inverse.add(found.variable, 1.0 / truth[1]);
    covered.add(found.interval_low < truth[1] && truth[1] < found.interval_high ? 1.0 : 0.0);
    length.add(fit_curve(measured, parameters(FitVariable::value), detector.model()).parameters[1].value,
               truth[1]);
  }
  for (const Pulls* pulls : {&amplitude, &inverse}) {
    CHECK(std::abs(pulls->mean().value) < kSigmas * pulls->mean().error);
    CHECK(std::abs(pulls->width().value - 1.0) < kSigmas * pulls->width().error);
  }
  CHECK(std::abs(covered.mean().value - 0.683) < kSigmas * covered.mean().error);
  CHECK(length.width().value - 1.0 > kSigmas * length.width().error);
}

TEST_CASE("The inverse of a parameter has the bounds of the parameter") {
  const ToyDetector detector(kDepths, 20'000, 5, falling);
  const auto fitted = [&](const std::vector<double>& truth, double low, double high) {
    return fit_curve(
        measured_curve(falling, truth, 1.0, 0.003, 5),
        {{"amplitude", 0.4, 0.05, 1.0}, {"length", 0.5 * (low + high), low, high, FitVariable::inverse}},
        detector.model());
  };
  const CurveFit above = fitted({0.6, 30.0}, 3.0, 20.0);
  CHECK(above.parameters[1].at_high);
  CHECK_FALSE(above.parameters[1].at_low);
  CHECK(above.parameters[1].interval_high == doctest::Approx(20.0));
  const CurveFit below = fitted({0.6, 5.0}, 8.0, 60.0);
  CHECK(below.parameters[1].at_low);
  CHECK(below.parameters[1].value.value >= 8.0);
  const CurveFit undetermined =
      fit_curve(measured_curve(falling, {0.6, 500.0}, 1.0, 0.3, 5),
                {{"amplitude", 0.4, 0.05, 1.0}, {"length", 700.0, 400.0, 1000.0, FitVariable::inverse}},
                detector.model());
  CHECK_FALSE(undetermined.parameters[1].determined);
  REQUIRE_FALSE(undetermined.warnings.empty());
  CHECK(
      std::any_of(undetermined.warnings.begin(), undetermined.warnings.end(), [](const std::string& warning) {
        return warning.find("does not determine length: the error of its inverse") != std::string::npos &&
               warning.find("between 0.001 and 0.0025") != std::string::npos;
      }));
  check_contains(complaint_of([&] {
                   fitted({0.6, 5.0}, -1.0, 60.0);
                 }),
                 {"the inverse of length is fitted", "lower bound is -1"});
}

TEST_CASE("Errors and chi-square are right, too, where photon paths soon diverge") {
  // Each photon's number turns with the parameter at a speed of its own, once round in some errors: noise
  // that common random numbers hardly lessen, and that a search would follow to a curve that is too good.
  const std::vector<double> truth{0.6, 12.0};
  constexpr std::size_t kPhotons = 2000;
  Pulls amplitude, length;
  Moments chi2, ratio;
  constexpr int kToys = 120;
  for (int toy = 0; toy < kToys; ++toy) {
    const auto seed = static_cast<std::uint64_t>(9000 + toy);
    const CurveModel chaotic = [&](const std::vector<double>& p, std::uint64_t draw) {
      ModelCurve curve;
      for (std::size_t i = 0; i < kDepths.size(); ++i) {
        Rng rng = toy_rng(seed, 1000 + 100 * draw + i);
        std::vector<std::uint64_t> parts(kToyParts, 0);
        for (std::size_t k = 0; k < kPhotons; ++k) {
          const double at = rng.uniform(), speed = rng.uniform() - 0.5;
          const double turned = at + speed * (p[1] + 20.0 * p[0]);
          parts[k % kToyParts] += turned - std::floor(turned) < falling(kDepths[i], p) ? 1 : 0;
        }
        ModelPoint point;
        std::uint64_t detected = 0;
        for (const std::uint64_t part : parts) {
          detected += part;
          point.parts.push_back(static_cast<double>(part * kToyParts) / kPhotons);
        }
        point.value = binomial_estimate(detected, kPhotons);
        curve.push_back(point);
      }
      return curve;
    };
    const CurveFit fit = fit_curve(measured_curve(falling, truth, 1.0, 0.01, seed), kFalling, chaotic);
    REQUIRE(fit.has_errors);
    amplitude.add(fit.parameters[0].value, truth[0]);
    length.add(fit.parameters[1].value, truth[1]);
    chi2.add(fit.goodness.chi2);
    ratio.add(fit.variance_ratio);
  }
  CHECK(ratio.mean().value < 3.0);
  for (const Pulls* pulls : {&amplitude, &length}) {
    CHECK(std::abs(pulls->mean().value) < kSigmas * pulls->mean().error);
    CHECK(std::abs(pulls->width().value - 1.0) < kSigmas * pulls->width().error);
  }
  CHECK(std::abs(chi2.mean().value - 6.0) < kSigmas * std::sqrt(12.0 / kToys));
}

TEST_CASE("A free scale is fitted with the parameters, in any unit of the measured light") {
  const std::vector<double> truth{0.2, 6.0};
  const std::vector<FitParameter> parameters{{"floor", 0.4, 0.0, 0.9}, {"length", 10.0, 1.0, 40.0}};
  Pulls floor, length, scale;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ToyDetector detector(kDepths, 4000, 500 + seed, levelling);
    CurveFitOptions options;
    options.free_scale = true;
    const CurveFit fit = fit_curve(measured_curve(levelling, truth, 1234.0, 0.006, 500 + seed), parameters,
                                   detector.model(), options);
    REQUIRE(fit.has_errors);
    floor.add(fit.parameters[0].value, truth[0]);
    length.add(fit.parameters[1].value, truth[1]);
    scale.add(fit.scale, 1234.0);
  }
  for (const Pulls* pulls : {&floor, &length, &scale}) {
    CHECK(std::abs(pulls->mean().value) < kSigmas * pulls->mean().error);
    CHECK(std::abs(pulls->width().value - 1.0) < kSigmas * pulls->width().error);
  }
}

TEST_CASE("Common random numbers reduce the noise of differences, and the fit has the factor") {
  const ToyDetector detector(kDepths, 2000, 1, falling);
  const CurveFit fit =
      fit_curve(measured_curve(falling, {0.6, 12.0}, 1.0, 0.01, 1), kFalling, detector.model());
  // Here a photon changes its fate with the probability |difference of the law|, so that the variance of a
  // difference is that over N, against 2 p (1 - p) / N: over one error to each side a factor of ten or so.
  CHECK(fit.variance_ratio > 3.0);
}

TEST_CASE("The same fit is the same to the last bit, and starts elsewhere lead to the same place") {
  const ToyDetector detector(kDepths, 2000, 3, falling);
  const MeasuredCurve measured = measured_curve(falling, {0.6, 12.0}, 1.0, 0.01, 3);
  const CurveFit one = fit_curve(measured, kFalling, detector.model());
  const CurveFit same = fit_curve(measured, kFalling, detector.model());
  CHECK(one.parameters[1].value.value == same.parameters[1].value.value);
  for (const double start : {4.0, 45.0}) {
    std::vector<FitParameter> other = kFalling;
    other[1].start = start;
    const CurveFit fit = fit_curve(measured, other, detector.model());
    // Where the search ends on the noise of the curve, it does so well within an error.
    CHECK(std::abs(fit.parameters[1].value.value - one.parameters[1].value.value) <
          0.5 * one.parameters[1].value.error);
  }
}

TEST_CASE("A parameter whose best value lies beyond a bound stays at it, with a warning") {
  const ToyDetector detector(kDepths, 20000, 4, falling);
  const MeasuredCurve measured = measured_curve(falling, {0.6, 12.0}, 1.0, 0.005, 4);
  std::vector<FitParameter> narrow = kFalling;
  narrow[1] = {"length", 5.0, 3.0, 9.0};
  const CurveFit fit = fit_curve(measured, narrow, detector.model());
  CHECK(fit.parameters[1].at_high);
  CHECK_FALSE(fit.parameters[1].at_low);
  CHECK(fit.parameters[1].value.value <= 9.0);
  CHECK(fit.parameters[1].value.value > 8.99);
  CHECK(fit.goodness.p_value < 1e-6);
  std::string warnings;
  for (const std::string& warning : fit.warnings) warnings += warning + "\n";
  check_contains(warnings, "length is at its upper bound, 9");
  check_contains(warnings, "does not describe the measurement");
}

TEST_CASE("A parameter that the data do not determine has a warning") {
  const auto warnings_of = [](const CurveFit& fit) {
    std::string text;
    for (const std::string& warning : fit.warnings) text += warning + "\n";
    return text;
  };
  const MeasuredCurve measured = measured_curve(falling, {0.6, 12.0}, 1.0, 0.01, 5);

  const ToyDetector blind(kDepths, 2000, 5,
                          [](double x, const std::vector<double>& p) { return p[0] * std::exp(-x / 12.0); });
  const CurveFit blind_fit = fit_curve(measured, kFalling, blind.model());
  REQUIRE(blind_fit.has_errors);
  CHECK(blind_fit.parameters[0].determined);
  CHECK_FALSE(blind_fit.parameters[1].determined);
  check_contains(warnings_of(blind_fit), "does not determine length");
  CHECK(std::abs(blind_fit.parameters[0].value.value - 0.6) < kSigmas * blind_fit.parameters[0].value.error);

  const ToyDetector product(kDepths, 20000, 5, [](double x, const std::vector<double>& p) {
    return p[0] * p[1] * std::exp(-x / 12.0);
  });
  const CurveFit twins =
      fit_curve(measured, {{"one", 0.7, 0.3, 1.0}, {"other", 0.8, 0.3, 1.0}}, product.model());
  REQUIRE(twins.has_errors);
  CHECK(twins.correlation(0, 1) < -0.98);
  check_contains(warnings_of(twins), "determines a combination");
}

TEST_CASE("Dominant Monte Carlo noise has a warning") {
  const ToyDetector detector(kDepths, 1000, 6, falling);
  const CurveFit fit =
      fit_curve(measured_curve(falling, {0.6, 12.0}, 1.0, 0.001, 6), kFalling, detector.model());
  REQUIRE_FALSE(fit.warnings.empty());
  CHECK(std::any_of(fit.warnings.begin(), fit.warnings.end(),
                    [](const std::string& warning) { return contains(warning, "is Monte Carlo noise"); }));
  CHECK(std::abs(fit.parameters[1].value.value - 12.0) < kSigmas * fit.parameters[1].value.error);
}

TEST_CASE("One error for all points is estimated from the scatter") {
  std::vector<double> depths;
  for (int i = 0; i < 60; ++i) depths.push_back(0.5 + 0.33 * i);
  const ToyDetector detector(depths, 20000, 8, falling);
  MeasuredCurve measured = measured_curve(falling, {0.6, 12.0}, 1.0, 0.02, 8, depths);
  measured.has_errors = false;
  for (MeasuredCurve::Point& point : measured.points) point.y.error = 0.0;
  CurveFitOptions options;
  options.errors_from_scatter = true;
  const CurveFit fit = fit_curve(measured, kFalling, detector.model(), options);
  REQUIRE(fit.common_error);
  // A standard deviation from 58 degrees of freedom has an error of sigma / sqrt(116).
  CHECK(std::abs(*fit.common_error - 0.02) < kSigmas * 0.02 / std::sqrt(116.0));
  CHECK(fit.goodness.chi2 == doctest::Approx(58.0).epsilon(1e-6));
  CHECK(std::abs(fit.parameters[1].value.value - 12.0) < kSigmas * fit.parameters[1].value.error);
}

TEST_CASE("A curve without noise is fitted as by any least squares") {
  MeasuredCurve measured;
  measured.has_errors = true;
  for (const double x : kDepths) measured.points.push_back({x, {2.0 + 3.0 * x, 0.1}, {}});
  const CurveModel line = [](const std::vector<double>& p, std::uint64_t) {
    ModelCurve curve;
    for (const double x : kDepths) curve.push_back({{p[0] + p[1] * x, 0.0}, {}});
    return curve;
  };
  const CurveFit fit = fit_curve(measured, {{"offset", 1.0, -10.0, 10.0}, {"slope", 1.0, 0.0, 10.0}}, line);
  CHECK(fit.end == FitEnd::converged);
  double n = 0.0, sx = 0.0, sxx = 0.0;
  for (const double x : kDepths) {
    n += 1.0;
    sx += x;
    sxx += x * x;
  }
  // Errors of a straight line: any book, as Press et al., Numerical Recipes, section 15.2.
  const double d = n * sxx - sx * sx;
  CHECK(fit.parameters[0].value.error == doctest::Approx(0.1 * std::sqrt(sxx / d)).epsilon(1e-6));
  CHECK(fit.parameters[1].value.error == doctest::Approx(0.1 * std::sqrt(n / d)).epsilon(1e-6));
  CHECK(fit.correlation(0, 1) == doctest::Approx(-sx / std::sqrt(n * sxx)).epsilon(1e-6));
  CHECK(std::abs(fit.parameters[0].value.value - 2.0) < 0.1 * fit.parameters[0].value.error);
  CHECK(std::abs(fit.parameters[1].value.value - 3.0) < 0.1 * fit.parameters[1].value.error);
  CHECK(fit.parameters[0].monte_carlo_error == 0.0);
}

TEST_CASE("A fit that is stopped keeps the best so far") {
  const ToyDetector detector(kDepths, 2000, 9, falling);
  const MeasuredCurve measured = measured_curve(falling, {0.6, 12.0}, 1.0, 0.01, 9);
  std::size_t left = 7;
  const CurveModel stopping = [&](const std::vector<double>& p,
                                  std::uint64_t draw) -> std::optional<ModelCurve> {
    if (left == 0) return std::nullopt;
    --left;
    return detector.trace(p, draw);
  };
  const CurveFit fit = fit_curve(measured, kFalling, stopping);
  CHECK(fit.end == FitEnd::stopped);
  REQUIRE(fit.curve.size() == kDepths.size());
  REQUIRE(fit.steps.size() >= 2);
  CHECK(fit.steps.back().chi2 < fit.steps.front().chi2);
  CHECK(fit.parameters[1].value.value == fit.steps.back().parameters[1]);
  left = 0;
  CHECK(fit_curve(measured, kFalling, stopping).curve.empty());
}

TEST_CASE("A fit that is impossible is refused with the reason") {
  const ToyDetector detector(kDepths, 2000, 10, falling);
  MeasuredCurve measured = measured_curve(falling, {0.6, 12.0}, 1.0, 0.01, 10);
  const auto complaint = [&](const MeasuredCurve& curve, const std::vector<FitParameter>& parameters,
                             const CurveFitOptions& options = {}) {
    return complaint_of([&] { fit_curve(curve, parameters, detector.model(), options); });
  };
  check_contains(complaint(measured, {}), "a fit without parameters");
  check_contains(complaint(measured, {kFalling[0], {"length", 3.0, 3.0, 60.0}}),
                 "does not lie between 3 and 60");
  MeasuredCurve two = measured;
  two.points.resize(2);
  CurveFitOptions free;
  free.free_scale = true;
  check_contains(complaint(two, kFalling, free), "2 measured points; expected 3 at least");
  MeasuredCurve bare = measured;
  bare.has_errors = false;
  check_contains(complaint(bare, kFalling), "have no errors");
  const CurveModel dark = [](const std::vector<double>&, std::uint64_t) {
    return ModelCurve(kDepths.size(), ModelPoint{{0.0, 0.01}, {}});
  };
  check_contains(complaint_of([&] { fit_curve(measured, kFalling, dark); }), "there is no light");
  const CurveModel short_model = [](const std::vector<double>&, std::uint64_t) { return ModelCurve(3); };
  CHECK_THROWS_AS(fit_curve(measured, kFalling, short_model), std::invalid_argument);
}
