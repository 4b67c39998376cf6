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

/// Number of values at or below one, of values that increase. Without branches, which would be predicted
/// wrongly half of the time.
std::size_t count_up_to(const std::vector<double>& values, double x) {
  const double* first = values.data();
  for (std::size_t left = values.size(); left > 1;) {
    const std::size_t half = left / 2;
    first += half * static_cast<std::size_t>(first[half - 1] <= x);
    left -= half;
  }
  return static_cast<std::size_t>(first - values.data()) + static_cast<std::size_t>(*first <= x);
}

}  // namespace

Curve::Curve(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
  check_table(x_, y_);
}

Curve Curve::constant(double value) { return Curve({0.0}, {value}); }

double Curve::operator()(double x) const {
  if (x_.size() == 1 || x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const std::size_t i = count_up_to(x_, x);
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
  const std::size_t i = count_up_to(x_, x);
  const double t = (x - x_[i - 1]) / (x_[i] - x_[i - 1]);
  return (1.0 - t) * slope_at(i - 1) + t * slope_at(i);
}

bool Curve::covers(double low, double high) const {
  return is_constant() || (low >= x_.front() && high <= x_.back());
}

double Curve::min_y() const { return *std::min_element(y_.begin(), y_.end()); }
double Curve::max_y() const { return *std::max_element(y_.begin(), y_.end()); }

CurveSampler::CurveSampler(const Curve& density)
    : first_x_(density.x().front()), last_x_(density.x().back()), mean_(first_x_) {
  const std::vector<double>&x = density.x(), &y = density.y();
  for (std::size_t i = 0; i < y.size(); ++i)
    if (y[i] < 0.0)
      throw InputError({{},
                        "a spectrum is negative (" + std::to_string(y[i]) + ") at " + std::to_string(x[i]),
                        "a spectrum is a density and cannot be negative"});
  double first_moment = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double width = x[i] - x[i - 1];
    intervals_.push_back({integral_, x[i - 1], width, y[i - 1], y[i] - y[i - 1]});
    integral_ += 0.5 * (y[i] + y[i - 1]) * width;
    first_moment += width * ((2.0 * x[i - 1] + x[i]) * y[i - 1] + (x[i - 1] + 2.0 * x[i]) * y[i]) / 6.0;
  }
  if (intervals_.empty()) return;
  if (!(integral_ > 0.0))
    throw InputError({{}, "a spectrum is zero everywhere", "give at least one positive value"});
  mean_ = first_moment / integral_;
  constexpr std::size_t kStepsPerInterval = 4;
  guide_.resize(kStepsPerInterval * intervals_.size());
  std::uint32_t at = 0;
  for (std::size_t step = 0; step < guide_.size(); ++step) {
    const double area = static_cast<double>(step) / static_cast<double>(guide_.size()) * integral_;
    while (at + 1 < intervals_.size() && intervals_[at + 1].below <= area) ++at;
    guide_[step] = at;
  }
}

/// The last interval that starts at or below an area, which is u times the integral.
const CurveSampler::Interval& CurveSampler::interval_at(double u, double area) const {
  const auto step = static_cast<std::size_t>(u * static_cast<double>(guide_.size()));
  const Interval* at = &intervals_[guide_[std::min(step, guide_.size() - 1)]];
  while (at > intervals_.data() && at->below > area) --at;  // by rounding, at the start of a step
  const Interval* const last = &intervals_.back();
  while (at < last && at[1].below <= area) ++at;
  return *at;
}

double CurveSampler::sample(double u) const {
  if (intervals_.empty()) return first_x_;
  const double area = u * integral_;
  const Interval& at = interval_at(u, area);
  // Within a trapezoid: y0 t + (y1 - y0) t^2 / 2 = remaining / width, solved without cancellation.
  const double rest = (area - at.below) / at.width;
  const double root = std::sqrt(std::max(0.0, at.y * at.y + 2.0 * at.step * rest));
  const double t = at.y + root > 0.0 ? 2.0 * rest / (at.y + root) : 0.0;
  return at.x + std::clamp(t, 0.0, 1.0) * at.width;
}

double CurveSampler::share_below(double x) const {
  if (x <= first_x_) return 0.0;
  if (x >= last_x_) return 1.0;
  const auto above =
      std::upper_bound(intervals_.begin(), intervals_.end(), x,
                       [](double value, const Interval& interval) { return value < interval.x; });
  const Interval& at = *(above - 1);
  const double t = (x - at.x) / at.width;
  const double part = at.width * t * (at.y + 0.5 * t * at.step);
  return std::min(1.0, (at.below + part) / integral_);
}

}  // namespace scintray::core
