// Depth curves, depth of interaction and layers against attenuation with known truth.
#include <doctest/doctest.h>

#include <limits>

#include "analysis/toys.hpp"
#include "scintray/analysis/position/confusion.hpp"
#include "scintray/analysis/position/depth_curve.hpp"
#include "scintray/analysis/position/depth_of_interaction.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;
using doctest::Approx;

namespace {

constexpr double kLength_mm = 20.0, kAttenuation_mm = 60.0, kLight = 1500.0;

struct Ends {
  std::vector<double> depths, near, far;
};

/// Light that is attenuated exponentially on its way to either end of a crystal.
Ends two_ends(int events, std::uint64_t stream) {
  Ends ends;
  Rng rng = toy_rng(stream);
  for (int i = 0; i < events; ++i) {
    const double z = kLength_mm * rng.uniform();
    const double a = kLight * std::exp(-z / kAttenuation_mm),
                 b = kLight * std::exp(-(kLength_mm - z) / kAttenuation_mm);
    ends.depths.push_back(z);
    ends.near.push_back(a + std::sqrt(a) * sample_normal(rng));
    ends.far.push_back(b + std::sqrt(b) * sample_normal(rng));
  }
  return ends;
}

std::vector<double> ratios_of(const Ends& ends, EndRatio kind) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ends.near.size(); ++i)
    ratios.push_back(end_ratio(kind, ends.near[i], ends.far[i]));
  return ratios;
}

}  // namespace

TEST_CASE("Pulls of a weighted line are normal") {
  Pulls offset, slope, middle;
  const std::vector<double> x{1.0, 4.0, 5.0, 9.0};
  for (std::uint64_t toy = 0; toy < 400; ++toy) {
    Rng rng = toy_rng(20, toy);
    std::vector<Estimate> y;
    for (const double at : x) {
      const double error = 0.1 + 0.05 * at;
      y.push_back({3.0 - 0.2 * at + error * sample_normal(rng), error});
    }
    const StraightLine line = fit_line(x, y);
    offset.add(line.offset, 3.0);
    slope.add(line.slope, -0.2);
    middle.add(line.at(7.0), 1.6);
  }
  for (const Pulls* pulls : {&offset, &slope, &middle}) {
    CHECK(sigmas(pulls->mean(), {0.0, 0.0}) < kSigmas);
    CHECK(sigmas(pulls->width(), {1.0, 0.0}) < kSigmas);
  }
  const std::vector<Estimate> two{{1.0, 0.1}, {2.0, 0.1}};
  CHECK_THROWS_AS(fit_line(std::vector<double>{2.0, 2.0}, two), std::invalid_argument);
  CHECK_THROWS_AS(fit_line(std::vector<double>{2.0}, two), std::invalid_argument);
}

TEST_CASE("Pulls of the relative slope and the ratios of a depth curve are normal") {
  Pulls slope, ratio;
  for (std::uint64_t toy = 0; toy < 400; ++toy) {
    Rng rng = toy_rng(21, toy);
    std::vector<DepthPoint> points;
    for (const double depth : {18.0, 2.0, 6.0, 14.0, 10.0})
      points.push_back({depth, 100, {1000.0 - 10.0 * depth + 12.0 * sample_normal(rng), 12.0}});
    const DepthCurve curve = depth_curve(points, 3.0);
    CHECK(curve.points.front().depth_mm == 2.0);
    CHECK(curve.reference == 0);
    CHECK(curve.relative[0].value == 1.0);
    slope.add(curve.relative_slope_per_mm, -10.0 / 900.0);
    ratio.add(curve.relative[4], 820.0 / 980.0);
  }
  for (const Pulls* pulls : {&slope, &ratio}) {
    CHECK(sigmas(pulls->mean(), {0.0, 0.0}) < kSigmas);
    CHECK(sigmas(pulls->width(), {1.0, 0.0}) < kSigmas);
  }
  CHECK_THROWS_AS(depth_curve({}, 0.0), std::invalid_argument);
}

TEST_CASE("A depth curve of events takes photopeaks where all slices have one, means where not") {
  Rng rng = toy_rng(22);
  std::vector<double> depths, light;
  for (int i = 0; i < 6000; ++i) {
    depths.push_back(kLength_mm * rng.uniform());
    light.push_back((1000.0 - 10.0 * depths.back()) * (1.0 + 0.05 * sample_normal(rng)));
    if (i % 3 != 0) continue;  // Compton events
    depths.push_back(kLength_mm * rng.uniform());
    light.push_back(600.0 * rng.uniform());
  }
  const std::vector<DepthPoint> points = depth_points(depths, light, 5);
  REQUIRE(points.size() == 5);
  for (const DepthPoint& point : points) {
    CHECK(point.from_peak);
    // The peak of a slice is that of its middle: light falls linearly.
    CHECK(sigmas(point.value, {1000.0 - 10.0 * point.depth_mm, 0.0}) < kSigmas);
  }
  const std::vector<DepthPoint> few =
      depth_points(std::span(depths).first(200), std::span(light).first(200), 5);
  REQUIRE(few.size() == 5);
  CHECK_FALSE(few.front().from_peak);
}

TEST_CASE("Law: the logarithm of the two ends' light falls by 2 / attenuation length a mm") {
  const Ends ends = two_ends(8000, 23);
  const DoiAnalysis analysis = analyze_doi(ends.depths, ratios_of(ends, EndRatio::logarithm),
                                           EndRatio::logarithm, DoiCalibrationKind::linear);
  CHECK(sigmas(analysis.line.slope, {-2.0 / kAttenuation_mm, 0.0}) < kSigmas);
  // Poisson light at both ends: the variance of the logarithm is 1 / A + 1 / B, the same at all depths but
  // for cosh(2 z / attenuation length), which changes by 5 % here.
  REQUIRE(analysis.slices.size() == 10);
  for (const DoiSlice& slice : analysis.slices) {
    const double a = kLight * std::exp(-slice.depth_mm / kAttenuation_mm);
    const double b = kLight * std::exp(-(kLength_mm - slice.depth_mm) / kAttenuation_mm);
    const double fwhm = kFwhmPerSigma * 0.5 * kAttenuation_mm * std::sqrt(1.0 / a + 1.0 / b);
    CHECK(sigmas(slice.fwhm_mm, {fwhm, 0.0}) < kSigmas);
    // The calibration's own error, not in that of the slice, is a tenth of it and less.
    CHECK(std::abs(slice.bias_mm.value) < (kSigmas + 1.0) * slice.bias_mm.error);
  }
  CHECK(analysis.residual.count == 4000);
}

TEST_CASE("The share of one end, calibrated monotonously, resolves depth as well") {
  const Ends ends = two_ends(8000, 24);
  const DoiAnalysis share = analyze_doi(ends.depths, ratios_of(ends, EndRatio::share), EndRatio::share,
                                        DoiCalibrationKind::monotone);
  const DoiAnalysis logarithm = analyze_doi(ends.depths, ratios_of(ends, EndRatio::logarithm),
                                            EndRatio::logarithm, DoiCalibrationKind::linear);
  CHECK(share.residual.quantile_fwhm.value == Approx(logarithm.residual.quantile_fwhm.value).epsilon(0.1));
  CHECK(std::is_sorted(share.calibration.ratio.begin(), share.calibration.ratio.end()));
  CHECK(std::is_sorted(share.calibration.depth_mm.rbegin(), share.calibration.depth_mm.rend()));
}

TEST_CASE(
    "A polished crystal, whose ends detect the same light from every depth, has no depth of interaction") {
  Rng rng = toy_rng(25);
  std::vector<double> depths, ratios;
  for (int i = 0; i < 1000; ++i) {
    depths.push_back(20.0 * rng.uniform());
    ratios.push_back(0.5 + 0.02 * sample_normal(rng));
  }
  CHECK(contains(
      complaint_of([&] { analyze_doi(depths, ratios, EndRatio::share, DoiCalibrationKind::linear); }),
      "does not change with depth"));
  depths.assign(1000, 7.0);
  CHECK(contains(
      complaint_of([&] { analyze_doi(depths, ratios, EndRatio::share, DoiCalibrationKind::linear); }),
      "at one depth"));
  ratios.assign(1000, std::numeric_limits<double>::quiet_NaN());
  CHECK(contains(
      complaint_of([&] { analyze_doi(depths, ratios, EndRatio::share, DoiCalibrationKind::linear); }),
      "0 events"));
  CHECK(std::isnan(end_ratio(EndRatio::share, 0.0, 5.0)));
}

TEST_CASE("Law: two Gaussian layers are distinguished with probability Phi(distance / 2 sigma)") {
  Rng rng = toy_rng(26);
  std::vector<std::size_t> layer;
  std::vector<double> value;
  for (std::size_t i = 0; i < 12'000; ++i) {
    layer.push_back(static_cast<std::size_t>(3.0 * rng.uniform()));
    // Layer 1 is the lowest: the order of layers is not that of their values.
    static constexpr double kMeans[] = {3.0, 0.0, 8.0};
    value.push_back(kMeans[layer.back()] + sample_normal(rng));
  }
  const LayerAnalysis analysis = classify_layers(layer, value, 3);
  CHECK(analysis.order == std::vector<std::size_t>{1, 0, 2});
  CHECK(analysis.confusion.total() == 6000);
  const double phi = 0.5 * std::erfc(-1.5 / std::sqrt(2.0)), far = 0.5 * std::erfc(-2.5 / std::sqrt(2.0));
  // Thresholds of 4000 events are not the best ones by a little; that costs less than the error allowed.
  CHECK(sigmas(analysis.confusion.share_right(), {(phi + (phi + far - 1.0) + far) / 3.0, 0.0}) < kSigmas);
  CHECK(analysis.confusion.at(1, 2) == 0);
  CHECK_THROWS_AS(classify_layers(layer, value, 2), std::invalid_argument);
}
