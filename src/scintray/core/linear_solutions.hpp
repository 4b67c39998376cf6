#pragma once
/// Linear equations and principal axes by Eigen's decompositions, for matrices of any size. They are compiled
/// here alone: a decomposition for matrices of one size takes some seconds of compiling in each file that
/// names it.

#include <Eigen/Core>
#include <optional>

namespace scintray::core {

/// Of a x = b.
struct LeastSolution {
  Eigen::MatrixXd x;  ///< a column for each of b
  Eigen::Index rank;  ///< of a
};
/// The x of least squares, and of several the shortest, by a complete orthogonal decomposition.
/// @param threshold  share of the largest pivot below which one is taken as zero; nothing: by rounding
LeastSolution least_solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                             std::optional<double> threshold = std::nullopt);

/// Eigenvalues of a symmetric matrix, the least first, and eigenvectors of length 1 in columns.
struct PrincipalAxes {
  Eigen::VectorXd values;
  Eigen::MatrixXd directions;
};
PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

}  // namespace scintray::core
