#include "scintray/core/curve.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"

namespace scintray::core {

namespace {

void check_table(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.empty() || x.size() != y.size())
    throw InputError(
        {{},
         "a table of " + std::to_string(x.size()) + " abscissae and " + std::to_string(y.size()) + " values",
         "give as many values as abscissae, at least one"});
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
      throw InputError(
          {{}, "row " + std::to_string(i + 1) + " of a table is not finite", "remove or mend the row"});
    if (i > 0 && !(x[i] > x[i - 1]))
      throw InputError({{},
                        "a table is not sorted: row " + std::to_string(i + 1) + " has abscissa " +
                            std::to_string(x[i]) + " after " + std::to_string(x[i - 1]),
                        "sort the rows by strictly increasing abscissa"});
  }
}

}  // namespace

Curve::Curve(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
  check_table(x_, y_);
}

Curve Curve::constant(double value) { return Curve({0.0}, {value}); }

double Curve::operator()(double x) const {
  if (x_.size() == 1 || x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const std::size_t i = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin());
  const double t = (x - x_[i - 1]) / (x_[i] - x_[i - 1]);
  return y_[i - 1] + t * (y_[i] - y_[i - 1]);
}

double Curve::derivative(double x) const {
  if (x_.size() == 1) return 0.0;
  const auto slope_at = [this](std::size_t i) {
    const std::size_t low = i > 0 ? i - 1 : i;
    const std::size_t high = std::min(i + 1, x_.size() - 1);
    return (y_[high] - y_[low]) / (x_[high] - x_[low]);
  };
  if (x <= x_.front()) return slope_at(0);
  if (x >= x_.back()) return slope_at(x_.size() - 1);
  const std::size_t i = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin());
  const double t = (x - x_[i - 1]) / (x_[i] - x_[i - 1]);
  return (1.0 - t) * slope_at(i - 1) + t * slope_at(i);
}

bool Curve::covers(double low, double high) const {
  return is_constant() || (low >= x_.front() && high <= x_.back());
}

double Curve::min_y() const { return *std::min_element(y_.begin(), y_.end()); }
double Curve::max_y() const { return *std::max_element(y_.begin(), y_.end()); }

CurveSampler::CurveSampler(const Curve& density) : x_(density.x()), y_(density.y()) {
  for (std::size_t i = 0; i < y_.size(); ++i)
    if (y_[i] < 0.0)
      throw InputError({{},
                        "a spectrum is negative (" + std::to_string(y_[i]) + ") at " + std::to_string(x_[i]),
                        "a spectrum is a density and cannot be negative"});
  cumulative_.assign(1, 0.0);
  for (std::size_t i = 1; i < x_.size(); ++i)
    cumulative_.push_back(cumulative_.back() + 0.5 * (y_[i] + y_[i - 1]) * (x_[i] - x_[i - 1]));
  if (x_.size() > 1 && !(cumulative_.back() > 0.0))
    throw InputError({{}, "a spectrum is zero everywhere", "give at least one positive value"});
}

double CurveSampler::sample(double u) const {
  if (x_.size() == 1) return x_.front();
  const double area = u * cumulative_.back();
  std::size_t i = static_cast<std::size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), area) -
                                           cumulative_.begin());
  i = std::clamp<std::size_t>(i, 1, x_.size() - 1);
  // Within a trapezoid: y0 t + (y1 - y0) t^2 / 2 = remaining / width, solved without cancellation.
  const double width = x_[i] - x_[i - 1];
  const double rest = (area - cumulative_[i - 1]) / width;
  const double y0 = y_[i - 1], dy = y_[i] - y_[i - 1];
  const double root = std::sqrt(std::max(0.0, y0 * y0 + 2.0 * dy * rest));
  const double t = y0 + root > 0.0 ? 2.0 * rest / (y0 + root) : 0.0;
  return x_[i - 1] + std::clamp(t, 0.0, 1.0) * width;
}

double CurveSampler::share_below(double x) const {
  if (x <= x_.front()) return 0.0;
  if (x >= x_.back()) return 1.0;
  const auto i = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin());
  const double width = x_[i] - x_[i - 1], t = (x - x_[i - 1]) / width;
  const double part = width * t * (y_[i - 1] + 0.5 * t * (y_[i] - y_[i - 1]));
  return std::min(1.0, (cumulative_[i - 1] + part) / cumulative_.back());
}

double CurveSampler::mean() const {
  if (x_.size() == 1) return x_.front();
  double first_moment = 0.0;
  for (std::size_t i = 1; i < x_.size(); ++i) {
    const double width = x_[i] - x_[i - 1];
    first_moment += width * ((2.0 * x_[i - 1] + x_[i]) * y_[i - 1] + (x_[i - 1] + 2.0 * x_[i]) * y_[i]) / 6.0;
  }
  return first_moment / cumulative_.back();
}

}  // namespace scintray::core
