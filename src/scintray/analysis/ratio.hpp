#pragma once
/// The ratio of two sums.

#include <cmath>
#include <cstdint>

#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

/// Sum of y over sum of x, with the error that includes their correlation: the ratio estimator (W. G. Cochran
/// 1977, Sampling Techniques, 3rd edition, section 6.4).
class RatioOfSums {
 public:
  void add(double x, double y) {
    ++count_;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    xy_ += x * y;
    yy_ += y * y;
  }
  std::uint64_t count() const { return count_; }
  /// The ratio; zeros without an x, no error from fewer than two pairs.
  core::Estimate ratio() const {
    if (!(x_ > 0.0)) return {0.0, 0.0};
    const double r = y_ / x_;
    if (count_ < 2) return {r, 0.0};
    const auto n = static_cast<double>(count_);
    const double residual = std::fmax(0.0, yy_ - 2.0 * r * xy_ + r * r * xx_);
    return {r, std::sqrt(residual * n / (n - 1.0)) / x_};
  }

 private:
  std::uint64_t count_ = 0;
  double x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

}  // namespace scintray::analysis
