#include "scintray/analysis/fit/detail/fit_information.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "scintray/core/linear_solutions.hpp"

namespace scintray::analysis {

namespace {

using Eigen::Index;

/// Share of the variance of each point after the fit of a scale: 1 - u_i^2, u the unit vector of the curve.
Eigen::VectorXd left_by_scale(const WeightedResiduals& residuals, const ModelCurve& centre) {
  Eigen::VectorXd left = Eigen::VectorXd::Ones(static_cast<Index>(centre.size()));
  if (!residuals.free_scale()) return left;
  Eigen::VectorXd u(left.size());
  for (Index i = 0; i < u.size(); ++i)
    u[i] = centre[static_cast<std::size_t>(i)].value.value * residuals.inverse_sigma()[i];
  const double square = u.squaredNorm();
  if (square > 0.0) left -= u.array().square().matrix() / square;
  return left;
}

/// Covariance of the slopes of one point from its parts, before weights.
Eigen::MatrixXd parts_covariance(const std::vector<DifferencePair>& pairs, std::size_t point) {
  const std::size_t parts = pairs.front().low[point].parts.size();
  Eigen::MatrixXd differences(static_cast<Index>(parts), static_cast<Index>(pairs.size()));
  for (std::size_t j = 0; j < pairs.size(); ++j)
    for (std::size_t part = 0; part < parts; ++part)
      differences(static_cast<Index>(part), static_cast<Index>(j)) =
          (pairs[j].high[point].parts[part] - pairs[j].low[point].parts[part]) / pairs[j].span;
  const Eigen::MatrixXd centred = differences.rowwise() - differences.colwise().mean();
  const auto n = static_cast<double>(parts);
  return centred.transpose() * centred / (n * (n - 1.0));
}

bool has_parts(const std::vector<DifferencePair>& pairs, std::size_t point) {
  const std::size_t parts = pairs.front().low[point].parts.size();
  for (const DifferencePair& pair : pairs)
    if (pair.low[point].parts.size() != parts || pair.high[point].parts.size() != parts) return false;
  return parts >= 2;
}

/// J^T J in units in which its diagonal is 1, by its principal directions, with the noise of J along each.
struct PrincipalInformation {
  PrincipalInformation(const FitSlopes& slopes, const Eigen::VectorXd& range) {
    // Three times the inverse squared range is the information of twice the error of a uniform distribution.
    const Eigen::VectorXd least = 3.0 * range.array().square().inverse().matrix();
    const Eigen::MatrixXd raw = slopes.slope.transpose() * slopes.slope;
    const Eigen::MatrixXd all_noise = slopes.summed_noise();
    unit = raw.diagonal().cwiseMax(least).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = unit.asDiagonal() * raw * unit.asDiagonal();
    core::PrincipalAxes axes = core::principal_axes(scaled);
    values = std::move(axes.values);
    directions = std::move(axes.directions);
    noise.resize(values.size());
    for (Index k = 0; k < values.size(); ++k) {
      const Eigen::VectorXd direction = unit.cwiseProduct(directions.col(k));
      noise[k] = direction.dot(all_noise * direction);
      values[k] = std::max(values[k] - noise[k], direction.dot(least.cwiseProduct(direction)));
    }
  }

  Eigen::VectorXd unit;
  Eigen::MatrixXd directions;     ///< of length 1, in columns
  Eigen::VectorXd values, noise;  ///< information less noise, and noise, along each
};

}  // namespace

Eigen::MatrixXd FitSlopes::summed_noise() const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(slope.cols(), slope.cols());
  for (const Eigen::MatrixXd& point : noise) sum += point;
  return sum;
}

FitSlopes slopes_of(const WeightedResiduals& residuals, const ModelCurve& centre,
                    const std::vector<DifferencePair>& pairs) {
  const auto points = static_cast<Index>(centre.size());
  const auto parameters = static_cast<Index>(pairs.size());
  FitSlopes slopes;
  slopes.slope.resize(points, parameters);
  for (Index j = 0; j < parameters; ++j) {
    const DifferencePair& pair = pairs[static_cast<std::size_t>(j)];
    slopes.slope.col(j) = (residuals.of(pair.high) - residuals.of(pair.low)) / pair.span;
  }
  const double scale = residuals.scale(centre);
  const Eigen::VectorXd left = left_by_scale(residuals, centre);
  for (Index i = 0; i < points; ++i) {
    const auto point = static_cast<std::size_t>(i);
    const double weight = std::pow(scale * residuals.inverse_sigma()[i], 2) * left[i];
    Eigen::VectorXd independent(parameters), span_squared(parameters);
    for (Index j = 0; j < parameters; ++j) {
      const DifferencePair& pair = pairs[static_cast<std::size_t>(j)];
      span_squared[j] = pair.span * pair.span;
      independent[j] =
          (std::pow(pair.low[point].value.error, 2) + std::pow(pair.high[point].value.error, 2)) /
          span_squared[j];
    }
    Eigen::MatrixXd noise = independent.asDiagonal();
    if (has_parts(pairs, point)) noise = parts_covariance(pairs, point);
    slopes.noise.push_back(weight * noise);
    slopes.common_variance += weight * noise.diagonal().cwiseProduct(span_squared).sum();
    slopes.independent_variance += weight * independent.cwiseProduct(span_squared).sum();
  }
  return slopes;
}

Eigen::MatrixXd information_of(const FitSlopes& slopes, const Eigen::VectorXd& range) {
  const PrincipalInformation principal(slopes, range);
  const Eigen::MatrixXd mended =
      principal.directions * principal.values.asDiagonal() * principal.directions.transpose();
  return principal.unit.cwiseInverse().asDiagonal() * mended * principal.unit.cwiseInverse().asDiagonal();
}

Eigen::VectorXd noise_share_of(const FitSlopes& slopes, const Eigen::VectorXd& range) {
  const PrincipalInformation principal(slopes, range);
  const Eigen::VectorXd alone =
      slopes.summed_noise().diagonal().cwiseQuotient(information_of(slopes, range).diagonal());
  const Eigen::MatrixXd parts =
      principal.directions.cwiseAbs2() * principal.noise.cwiseQuotient(principal.values).asDiagonal();
  return alone.cwiseMax(parts.rowwise().maxCoeff());
}

Eigen::MatrixXd step_information_of(const FitSlopes& slopes, const Eigen::VectorXd& range) {
  Eigen::MatrixXd information = slopes.slope.transpose() * slopes.slope;
  information.diagonal() += range.array().square().inverse().matrix();
  return information;
}

FitCovariance covariance_of(const FitSlopes& slopes, const Eigen::VectorXd& range, std::size_t steps,
                            const Eigen::VectorXd& residuals, const Eigen::VectorXd& monte_carlo_share) {
  const Eigen::MatrixXd information = information_of(slopes, range);
  const Eigen::MatrixXd inverse = information.inverse();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(inverse.rows(), inverse.cols());
  const Eigen::MatrixXd step = step_information_of(slopes, range).inverse() * information;
  Eigen::MatrixXd left = one;
  for (std::size_t k = 0; k < steps; ++k) left = left * (one - step);
  const Eigen::MatrixXd done = one - left;
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  for (Index i = 0; i < residuals.size(); ++i)
    moved += residuals[i] * residuals[i] * slopes.noise[static_cast<std::size_t>(i)];
  const Eigen::MatrixXd from_slopes = done * inverse * moved * inverse * done.transpose();
  // The share of the Monte Carlo errors, by the information of the points.
  const Eigen::VectorXd weight = (slopes.slope * range.asDiagonal()).rowwise().squaredNorm();
  const double share = weight.sum() > 0.0 ? weight.dot(monte_carlo_share) / weight.sum() : 0.0;
  const Eigen::MatrixXd mixed = share * done * inverse * left.transpose();
  const Eigen::MatrixXd of_mean = mixed + mixed.transpose();
  FitCovariance covariance;
  covariance.total = inverse - of_mean + from_slopes;
  covariance.monte_carlo =
      (share * inverse - of_mean + from_slopes).diagonal().cwiseMin(covariance.total.diagonal());
  return covariance;
}

}  // namespace scintray::analysis
