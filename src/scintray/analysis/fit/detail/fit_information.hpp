#pragma once
/// Derivatives of a curve by its parameters with their noise, and the covariances of the parameters.

#include <Eigen/Core>
#include <vector>

#include "scintray/analysis/fit/fit_residuals.hpp"

namespace scintray::analysis {

/// Curves on both sides of a point in one parameter.
struct DifferencePair {
  ModelCurve low, high;
  double span = 0.0;  ///< between the two values of the parameter, above 0
};

/// Derivatives of the residuals by the parameters, from central differences, with their Monte Carlo noise.
struct FitSlopes {
  Eigen::MatrixXd slope;               ///< points x parameters
  std::vector<Eigen::MatrixXd> noise;  ///< per point: covariance of its row
  /// Variance of the differences, summed over points and parameters in units of sigma^2: with common random
  /// numbers, and as it would be if each curve had its own.
  double common_variance = 0.0, independent_variance = 0.0;

  Eigen::MatrixXd summed_noise() const;
};

/// Derivatives from pairs of curves. With `parts` in the curves the noise is measured: the differences of
/// each part, of other photons, are independent repetitions of the whole difference. Without, both curves
/// count as independent.
/// @param pairs  one a parameter
FitSlopes slopes_of(const WeightedResiduals& residuals, const ModelCurve& centre,
                    const std::vector<DifferencePair>& pairs);

/// Fisher information J^T J minus the contribution of the noise of J (a square is never negative, so noise
/// appears as information). The noise is subtracted along the principal directions of J^T J; where less
/// remains than corresponds to an error of 1/sqrt(3) of the range of the parameters, twice that of a uniform
/// distribution between the bounds, it is set to that, so that an inverse exists.
/// @param range  of each parameter, high - low
Eigen::MatrixXd information_of(const FitSlopes& slopes, const Eigen::VectorXd& range);

/// Noise of the slopes by each parameter as a share of the information: of its own with the others held, or,
/// where that is larger, of that of a principal direction, weighted by the component of the parameter in it.
/// Where parameters are correlated, a direction has little information, and slopes must be more precise.
Eigen::VectorXd noise_share_of(const FitSlopes& slopes, const Eigen::VectorXd& range);

/// J^T J plus the information of a prior as wide as the range of the parameters, which keeps steps finite:
/// the matrix of the step equations. It includes the noise of J, which shortens steps where they are
/// uncertain.
Eigen::MatrixXd step_information_of(const FitSlopes& slopes, const Eigen::VectorXd& range);

/// Covariances of the parameters at the least squares.
struct FitCovariance {
  Eigen::MatrixXd total;
  Eigen::VectorXd monte_carlo;  ///< part of the variances from the simulation
};

/// With F the information (information_of), R that of steps (step_information_of), c the share of the Monte
/// Carlo errors in the errors of the residuals r, and S = 1 - (1 - R^-1 F)^k of k steps of the estimate:
///   F^-1 - c (A + A^T), A = S F^-1 (1 - S)^T,
/// where steps that are too short retain a share 1 - S of the result of the search, with Monte Carlo errors
/// of its own, so that the estimate is a mean of two simulations; and the effect of the noise N of the slopes
/// on the position of the minimum, S F^-1 (sum r_i^2 N_i) F^-1 S^T.
FitCovariance covariance_of(const FitSlopes& slopes, const Eigen::VectorXd& range, std::size_t steps,
                            const Eigen::VectorXd& residuals, const Eigen::VectorXd& monte_carlo_share);

}  // namespace scintray::analysis
