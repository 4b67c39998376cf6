#include "scintray/optics/height_spectrum.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"

namespace scintray::optics {

double GaussianSpectrum::variance_nm2(double per_nm) const {
  return -rms_nm_ * rms_nm_ * std::expm1(-std::pow(core::kPi * correlation_nm_ * per_nm, 2));
}

double GaussianSpectrum::frequency_per_nm(double share, double limit_per_nm) const {
  const double all = -std::expm1(-std::pow(core::kPi * correlation_nm_ * limit_per_nm, 2));
  return std::min(limit_per_nm, std::sqrt(-std::log1p(-share * all)) / (core::kPi * correlation_nm_));
}

double KCorrelationSpectrum::band(double per_nm) const {
  return -std::expm1(0.5 * (1.0 - exponent_) * std::log1p(std::pow(knee_nm_ * per_nm, 2)));
}

double KCorrelationSpectrum::variance_nm2(double per_nm) const { return rms_nm_ * rms_nm_ * band(per_nm); }

double KCorrelationSpectrum::frequency_per_nm(double share, double limit_per_nm) const {
  const double bf2 = std::expm1(std::log1p(-share * band(limit_per_nm)) * 2.0 / (1.0 - exponent_));
  return std::min(limit_per_nm, std::sqrt(bf2) / knee_nm_);
}

TabulatedSpectrum::TabulatedSpectrum(std::vector<double> per_nm, std::vector<double> density_nm4)
    : per_nm_(std::move(per_nm)), density_nm4_(std::move(density_nm4)), sums_nm2_{0.0} {
  for (std::size_t k = 0; k + 1 < per_nm_.size(); ++k)
    sums_nm2_.push_back(sums_nm2_.back() + within(k, per_nm_[k + 1]));
}

double TabulatedSpectrum::within(std::size_t segment, double per_nm) const {
  const double f0 = per_nm_[segment], f1 = per_nm_[segment + 1];
  const double s0 = density_nm4_[segment], s1 = density_nm4_[segment + 1];
  if (!(s0 > 0.0 && s1 > 0.0)) {
    const double slope = (s1 - s0) / (f1 - f0), start = s0 - slope * f0;
    return core::kTwoPi * (0.5 * start * (per_nm * per_nm - f0 * f0) +
                           slope * (per_nm * per_nm * per_nm - f0 * f0 * f0) / 3.0);
  }
  const double octaves = std::log(per_nm / f0);
  const double power = std::log(s1 / s0) / std::log(f1 / f0) + 2.0;
  constexpr double kLogarithm = 1e-9;
  const double grown = std::abs(power * octaves) < kLogarithm ? octaves : std::expm1(power * octaves) / power;
  return core::kTwoPi * s0 * f0 * f0 * grown;
}

double TabulatedSpectrum::variance_nm2(double per_nm) const {
  if (per_nm <= per_nm_.front()) return 0.0;
  if (per_nm >= per_nm_.back()) return sums_nm2_.back();
  const auto above = std::upper_bound(per_nm_.begin(), per_nm_.end(), per_nm);
  const auto segment = static_cast<std::size_t>(above - per_nm_.begin()) - 1;
  return sums_nm2_[segment] + within(segment, per_nm);
}

double TabulatedSpectrum::frequency_per_nm(double share, double limit_per_nm) const {
  const double wanted = share * variance_nm2(limit_per_nm);
  const auto above = std::upper_bound(sums_nm2_.begin() + 1, sums_nm2_.end() - 1, wanted);
  const auto segment = static_cast<std::size_t>(above - sums_nm2_.begin()) - 1;
  double low = per_nm_[segment], high = per_nm_[segment + 1];
  constexpr int kHalvings = 52;
  for (int k = 0; k < kHalvings && low < high; ++k) {
    const double middle = 0.5 * (low + high);
    (sums_nm2_[segment] + within(segment, middle) < wanted ? low : high) = middle;
  }
  return std::min(limit_per_nm, 0.5 * (low + high));
}

}  // namespace scintray::optics
