#include "scintray/core/linear_solutions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace scintray::core {

LeastSolution least_solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                             std::optional<double> threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  if (threshold) solver.setThreshold(*threshold);
  solver.compute(a);
  return {solver.solve(b), solver.rank()};
}

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace scintray::core
