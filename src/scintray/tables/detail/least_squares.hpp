#pragma once
/// Linear least squares on the nodes of a grid.

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <utility>
#include <vector>

namespace scintray::tables {

/// Rows of a linear least squares problem.
class LeastSquares {
 public:
  explicit LeastSquares(int unknowns)
      : matrix_(unknowns, unknowns), right_(Eigen::VectorXd::Zero(unknowns)) {}

  using Row = std::vector<std::pair<int, double>>;
  void add(const Row& row, double value) {
    for (const auto& [i, at_i] : row) {
      right_[i] += at_i * value;
      for (const auto& [j, at_j] : row) entries_.emplace_back(i, j, at_i * at_j);
    }
  }
  Eigen::VectorXd solve() {
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix_);
    return factors.solve(right_);
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd right_;
};

/// Weights of the two nodes about a place on a rising grid.
template <typename Node>
std::pair<int, double> grid_place(double at, int nodes, const Node& node) {
  int low = 0;
  while (low + 2 < nodes && at >= node(low + 1)) ++low;
  return {low, std::clamp((at - node(low)) / (node(low + 1) - node(low)), 0.0, 1.0)};
}

/// Weights of the eight nodes about a place on three grids, by their unknowns.
template <typename Number>
LeastSquares::Row grid_row(const Number& number, const std::pair<int, double>& in,
                           const std::pair<int, double>& out, const std::pair<int, double>& turn) {
  LeastSquares::Row row;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    row.emplace_back(number(in.first + i, out.first + j, turn.first + k),
                     (i ? in.second : 1.0 - in.second) * (j ? out.second : 1.0 - out.second) *
                         (k ? turn.second : 1.0 - turn.second));
  }
  return row;
}

}  // namespace scintray::tables
