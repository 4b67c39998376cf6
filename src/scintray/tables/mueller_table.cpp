#include "scintray/tables/mueller_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scintray/core/vec.hpp"
#include "scintray/tables/detail/least_squares.hpp"

namespace scintray::tables {

namespace {

constexpr double kMatrixSmoothness = 1.0;
constexpr int kFitPolar = 10, kFitTurns = 10;  ///< nodes of the fit, every 10 and 20 deg
constexpr double kMostPolarising = 0.99;       ///< of the first row: reflected light has an intensity above 0

/// An element of the upper triangle, and the sign of its transposed one in the reversed path.
struct Element {
  int row, column;
  bool odd;  ///< in the azimuth
  double reversed;
};
constexpr std::array<Element, 9> kElements{{{0, 1, false, 1.0},
                                            {0, 2, true, 1.0},
                                            {0, 3, true, -1.0},
                                            {1, 1, false, 1.0},
                                            {1, 2, true, 1.0},
                                            {1, 3, true, -1.0},
                                            {2, 2, false, 1.0},
                                            {2, 3, false, -1.0},
                                            {3, 3, false, 1.0}}};

/// Numbers of the unknowns of an element: those on the diagonal are the same for the reversed path.
class ElementNodes {
 public:
  explicit ElementNodes(const Element& element)
      : diagonal_(element.row == element.column), odd_(element.odd) {}
  static int count() { return kFitPolar * kFitPolar * kFitTurns; }
  int operator()(int a, int b, int k) const {
    if (diagonal_ && a > b) std::swap(a, b);
    return (a * kFitPolar + b) * kFitTurns + k;
  }
  bool odd() const { return odd_; }

 private:
  bool diagonal_, odd_;
};

double fit_polar_node(int node) { return 0.5 * core::kPi * node / (kFitPolar - 1); }
double fit_turn_node(int node) { return core::kPi * node / (kFitTurns - 1); }

/// Weights of the fit's nodes at two directions.
LeastSquares::Row fit_row(const ElementNodes& number, double in_rad, double out_rad, double turn_rad) {
  return grid_row(number, grid_place(in_rad, kFitPolar, fit_polar_node),
                  grid_place(out_rad, kFitPolar, fit_polar_node),
                  grid_place(turn_rad, kFitTurns, fit_turn_node));
}

void add_matrix_smoothness(LeastSquares& problem, const ElementNodes& number) {
  const auto add = [&](int before, int here, int after) {
    problem.add({{before, kMatrixSmoothness}, {here, -2.0 * kMatrixSmoothness}, {after, kMatrixSmoothness}},
                0.0);
  };
  // The normal equations of unknowns that no row has stay regular.
  constexpr double kLeast = 1e-6;
  for (int unknown = 0; unknown < ElementNodes::count(); ++unknown) problem.add({{unknown, kLeast}}, 0.0);
  constexpr int kLastTurn = kFitTurns - 1;
  for (int a = 0; a < kFitPolar; ++a)
    for (int b = 0; b < kFitPolar; ++b) {
      for (int k = 0; k < kFitTurns; ++k) {
        if (a > 0 && a + 1 < kFitPolar) add(number(a - 1, b, k), number(a, b, k), number(a + 1, b, k));
        if (b > 0 && b + 1 < kFitPolar) add(number(a, b - 1, k), number(a, b, k), number(a, b + 1, k));
        if (k > 0 && k < kLastTurn) add(number(a, b, k - 1), number(a, b, k), number(a, b, k + 1));
      }
      // Even across azimuths 0 and 180 deg, or 0 there.
      for (const auto& [end, next] : {std::pair{0, 1}, std::pair{kLastTurn, kLastTurn - 1}})
        if (number.odd())
          problem.add({{number(a, b, end), 1e3}}, 0.0);
        else
          add(number(a, b, next), number(a, b, end), number(a, b, next));
    }
}

}  // namespace

MuellerTable MuellerTable::fitted(const std::vector<BrdfPoint>& points, const BrdfTable& brdf) {
  MuellerTable table(brdf);
  for (std::size_t e = 0; e < kElements.size(); ++e) {
    const Element& element = kElements[e];
    const ElementNodes number(element);
    LeastSquares problem(ElementNodes::count());
    for (const BrdfPoint& point : points) {
      const Eigen::Matrix4d& m = *point.mueller;
      problem.add(fit_row(number, point.incidence_rad, point.polar_rad, point.turn_rad),
                  m(element.row, element.column));
      if (element.row != element.column)
        problem.add(fit_row(number, point.polar_rad, point.incidence_rad, point.turn_rad),
                    element.reversed * m(element.column, element.row));
    }
    add_matrix_smoothness(problem, number);
    const Eigen::VectorXd solution = problem.solve();
    table.elements_[e].resize(static_cast<std::size_t>(kBrdfPolar * kBrdfPolar * kBrdfTurns));
    for (int a = 0; a < kBrdfPolar; ++a)
      for (int b = 0; b < kBrdfPolar; ++b)
        for (int k = 0; k < kBrdfTurns; ++k) {
          const auto polar = [](int node) { return std::asin(std::sqrt(BrdfTable::polar_node(node))); };
          double value = 0.0;
          for (const auto& [unknown, weight] : fit_row(number, polar(a), polar(b), BrdfTable::turn_node(k)))
            value += weight * solution[unknown];
          table.elements_[e][BrdfTable::node(a, b, k)] = value;
        }
  }
  table.finish();
  table.rms_ = table.measured_rms(points);
  return table;
}

void MuellerTable::finish() {
  const auto polarising_at = [&](std::size_t node) {
    return std::sqrt(std::pow(elements_[0][node], 2) + std::pow(elements_[1][node], 2) +
                     std::pow(elements_[2][node], 2));
  };
  for (int a = 0; a < kBrdfPolar; ++a) {
    double sum = 0.0;
    for (int b = 0; b < kBrdfPolar; ++b)
      for (int k = 0; k < kBrdfTurns; ++k) {
        const std::size_t node = BrdfTable::node(a, b, k);
        const double polarising = polarising_at(node);
        if (polarising > kMostPolarising)
          for (std::size_t e = 0; e < 3; ++e) elements_[e][node] *= kMostPolarising / polarising;
        sum += brdf_.node_value(a, b, k) * elements_[0][node] * BrdfTable::node_integral(b, k);
      }
    // No light is reflected more than fully: what would exceed it is subtracted from all directions.
    const double all = brdf_.node_reflectance(a);
    const double most = std::max(0.0, std::min(all, 1.0 - all));
    const double kept = std::clamp(sum, -most, most);
    by_polarisation_[static_cast<std::size_t>(a)] = kept;
    for (int b = 0; b < kBrdfPolar; ++b)
      for (int k = 0; k < kBrdfTurns; ++k) {
        const std::size_t node = BrdfTable::node(a, b, k);
        if (all > 0.0) elements_[0][node] -= (sum - kept) / all;
        most_excess_ = std::max(most_excess_, polarising_at(node));
      }
  }
}

Eigen::Matrix4d MuellerTable::matrix(double x_in, double x_out, double turn_rad) const {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const BrdfTable::Corner& corner : BrdfTable::corners(x_in, x_out, std::abs(turn_rad))) {
    const double value = corner.weight * brdf_.node_value(corner.a, corner.b, corner.k);
    sum(0, 0) += value;
    for (std::size_t e = 0; e < kElements.size(); ++e) {
      const auto& [row, column, odd, reversed] = kElements[e];
      const double sign = odd && turn_rad < 0.0 ? -value : value;
      sum(row, column) += sign * elements_[e][BrdfTable::node(corner.a, corner.b, corner.k)];
      if (row != column)
        sum(column, row) += sign * reversed * elements_[e][BrdfTable::node(corner.b, corner.a, corner.k)];
    }
  }
  if (sum(0, 0) > 0.0) sum /= sum(0, 0);
  sum(0, 0) = 1.0;
  return sum;
}

double MuellerTable::reflectance(double x_in, double s1) const {
  double excess = 0.0;
  for (const BrdfTable::Corner& corner : BrdfTable::corners(x_in, 0.0, 0.0))
    excess += corner.weight * by_polarisation_[static_cast<std::size_t>(corner.a)];
  return std::clamp(brdf_.reflectance(x_in) + s1 * excess, 0.0, 1.0);
}

double MuellerTable::measured_rms(const std::vector<BrdfPoint>& points) const {
  double squares = 0.0;
  for (const BrdfPoint& point : points) {
    const auto x = [](double angle) { return std::pow(std::sin(angle), 2); };
    squares +=
        (matrix(x(point.incidence_rad), x(point.polar_rad), point.turn_rad) - *point.mueller).squaredNorm();
  }
  return std::sqrt(squares / (15.0 * static_cast<double>(points.size())));
}

}  // namespace scintray::tables
