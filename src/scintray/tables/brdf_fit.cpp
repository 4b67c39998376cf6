// The reciprocal table next to measured values of a BRDF.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scintray/core/vec.hpp"
#include "scintray/tables/brdf_table.hpp"
#include "scintray/tables/detail/least_squares.hpp"
#include "scintray/tables/mueller_table.hpp"

namespace scintray::tables {

namespace {

constexpr double kSmoothness = 0.05;
constexpr double kMostRms = 0.1;
constexpr std::size_t kLeastPoints = 20;

/// Number of an unknown: nodes of the two directions in either order, and along the normal of any azimuth,
/// have one value.
class UnknownNodes {
 public:
  UnknownNodes() {
    for (int a = 0; a < kBrdfPolar; ++a)
      for (int b = a; b < kBrdfPolar; ++b)
        for (int k = 0; k < (a == 0 ? 1 : kBrdfTurns); ++k) first(a, b, k) = count_++;
  }
  int operator()(int a, int b, int k) const {
    const int low = std::min(a, b), high = std::max(a, b);
    return numbers_[BrdfTable::node(low, high, low == 0 ? 0 : k)];
  }
  int count() const { return count_; }

 private:
  int& first(int a, int b, int k) { return numbers_[BrdfTable::node(a, b, k)]; }

  std::vector<int> numbers_ = std::vector<int>(kBrdfPolar * kBrdfPolar * kBrdfTurns, 0);
  int count_ = 0;
};

void add_points(LeastSquares& problem, const UnknownNodes& number, const std::vector<BrdfPoint>& points,
                double mean) {
  for (const BrdfPoint& point : points) {
    const auto x = [](double angle) { return std::pow(std::sin(angle), 2); };
    const auto in = grid_place(x(point.incidence_rad), kBrdfPolar, BrdfTable::polar_node);
    const auto out = grid_place(x(point.polar_rad), kBrdfPolar, BrdfTable::polar_node);
    const auto turn = grid_place(point.turn_rad, kBrdfTurns, BrdfTable::turn_node);
    const double weight = 1.0 / std::max(point.value_per_sr, 1e-3 * mean);
    LeastSquares::Row row = grid_row(number, in, out, turn);
    for (auto& [unknown, share] : row) share *= weight;
    problem.add(row, weight * point.value_per_sr);
  }
}

/// Second differences over polar angle and azimuth, across the normal too, are small.
void add_smoothness(LeastSquares& problem, const UnknownNodes& number, double mean) {
  const double weight = kSmoothness / mean;
  const auto add = [&](int before, int here, int after) {
    problem.add({{before, weight}, {here, -2.0 * weight}, {after, weight}}, 0.0);
  };
  constexpr int kLastTurn = kBrdfTurns - 1;
  for (int b = 0; b < kBrdfPolar; ++b)
    for (int k = 0; k < kBrdfTurns; ++k) {
      add(number(1, b, kLastTurn - k), number(0, b, k), number(1, b, k));
      for (int a = 1; a + 1 < kBrdfPolar; ++a) add(number(a - 1, b, k), number(a, b, k), number(a + 1, b, k));
      for (int a = 1; a <= b; ++a)
        add(number(a, b, std::abs(k - 1)), number(a, b, k),
            number(a, b, std::min(k + 1, 2 * kLastTurn - k - 1)));
    }
}

BrdfResiduals residuals_of(const BrdfTable& table, const std::vector<BrdfPoint>& points, double mean) {
  BrdfResiduals residuals = table.residuals();
  double sum = 0.0, squares = 0.0;
  for (const BrdfPoint& point : points) {
    const double x_in = std::pow(std::sin(point.incidence_rad), 2),
                 x_out = std::pow(std::sin(point.polar_rad), 2);
    const double deviation =
        table.value_per_sr(x_in, x_out, point.turn_rad) / std::max(point.value_per_sr, 1e-3 * mean) -
        point.value_per_sr / std::max(point.value_per_sr, 1e-3 * mean);
    sum += deviation;
    squares += deviation * deviation;
    residuals.largest = std::max(residuals.largest, std::abs(deviation));
  }
  residuals.points = points.size();
  residuals.mean = sum / static_cast<double>(points.size());
  residuals.rms = std::sqrt(squares / static_cast<double>(points.size()));
  return residuals;
}

}  // namespace

BrdfTable BrdfTable::fitted(const std::vector<BrdfPoint>& points) {
  std::set<long> incidences;
  double mean = 0.0;
  for (const BrdfPoint& point : points) {
    incidences.insert(std::lround(point.incidence_rad / core::kDegree));
    mean += point.value_per_sr / static_cast<double>(points.size());
  }
  if (points.size() < kLeastPoints || incidences.size() < 2 || !(mean > 0.0))
    throw core::InputError(
        {{},
         fmt::format(
             "{} values above 0 at {} angles of incidence at one wavelength; expected at least {} at 2",
             mean > 0.0 ? points.size() : 0, incidences.size(), kLeastPoints),
         "a BRDF is a table over both directions: give values at several angles of incidence"});
  const UnknownNodes number;
  LeastSquares problem(number.count());
  add_points(problem, number, points, mean);
  add_smoothness(problem, number, mean);
  const Eigen::VectorXd solution = problem.solve();
  BrdfTable table;
  for (int a = 0; a < kBrdfPolar; ++a)
    for (int b = 0; b < kBrdfPolar; ++b)
      for (int k = 0; k < kBrdfTurns; ++k) table.at(a, b, k) = std::max(0.0, solution[number(a, b, k)]);
  table.finish();
  table.residuals_ = residuals_of(table, points, mean);
  return table;
}

MeasuredBrdf fit_brdf(const std::vector<BrdfPoint>& points, const std::string& file) {
  std::map<double, std::vector<BrdfPoint>> by_wavelength;
  for (const BrdfPoint& point : points) by_wavelength[point.wavelength_nm].push_back(point);
  MeasuredBrdf brdf;
  for (const auto& [nm, own] : by_wavelength) {
    const auto refuse = [&, nm = nm](const std::string& what, const std::string& hint) {
      throw core::InputError({{file}, nm > 0.0 ? fmt::format("at {:g} nm: {}", nm, what) : what, hint});
    };
    try {
      brdf.tables.push_back(BrdfTable::fitted(own));
    } catch (const core::InputError& error) {
      refuse(error.problems().front().what, error.problems().front().hint);
    }
    const double rms = brdf.tables.back().residuals().rms;
    if (rms > kMostRms)
      refuse(
          fmt::format(
              "the reciprocal table differs from the values by {:.0f} % (rms); expected at most {:.0f} %",
              100.0 * rms, 100.0 * kMostRms),
          "the values are not reciprocal, or have a lobe narrower than its nodes, 5 deg by 10 deg: model the "
          "lobe as a mirror or by model = \"mirror_scatter\"");
    brdf.wavelengths_nm.push_back(nm);
  }
  if (std::all_of(points.begin(), points.end(),
                  [](const BrdfPoint& point) { return point.mueller.has_value(); }))
    for (std::size_t k = 0; k < brdf.tables.size(); ++k)
      brdf.mueller.push_back(MuellerTable::fitted(by_wavelength[brdf.wavelengths_nm[k]], brdf.tables[k]));
  return brdf;
}

}  // namespace scintray::tables
