#include "scintray/core/linear_solutions.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace scintray;
using namespace scintray::core;

namespace {

constexpr double kSolved = 1e-13;

}  // namespace

TEST_CASE("Of too many equations the solution has the least squares, of too few it is the shortest") {
  Eigen::MatrixXd line(4, 2);
  line << 0, 1, 1, 1, 2, 1, 3, 1;
  const LeastSolution fit = least_solution(line, Eigen::Vector4d(1.0, 2.9, 5.1, 7.0));
  CHECK(fit.rank == 2);
  CHECK((fit.x - Eigen::Vector2d(2.02, 0.97)).norm() < kSolved);
  Eigen::MatrixXd plane(1, 3);
  plane << 1.0, 2.0, 2.0;
  const LeastSolution nearest = least_solution(plane, Eigen::MatrixXd::Constant(1, 1, 9.0));
  CHECK(nearest.rank == 1);
  CHECK((nearest.x - Eigen::Vector3d(1.0, 2.0, 2.0)).norm() < kSolved);
}

TEST_CASE("Nearly parallel planes count as one below the threshold") {
  Eigen::MatrixXd planes(2, 3);
  planes << 0.0, 0.0, 1.0, 0.0, 1e-4, 1.0;
  const Eigen::Vector2d heights(1.0, 1.0);
  CHECK(least_solution(planes, heights).rank == 2);
  const LeastSolution one = least_solution(planes, heights, 1e-3);
  CHECK(one.rank == 1);
  CHECK((one.x - Eigen::Vector3d(0.0, 0.0, 1.0)).norm() < 1e-3);
}

TEST_CASE("Principal axes come with the least eigenvalue first, of unit length") {
  Eigen::MatrixXd rotation(2, 2);
  rotation << 0.8, -0.6, 0.6, 0.8;
  const Eigen::Vector2d values(-1.0, 3.0);
  const PrincipalAxes axes = principal_axes(rotation * values.asDiagonal() * rotation.transpose());
  CHECK((axes.values - values).norm() < kSolved);
  for (Eigen::Index k = 0; k < 2; ++k)
    CHECK(std::abs(std::abs(axes.directions.col(k).dot(rotation.col(k))) - 1.0) < kSolved);
}
