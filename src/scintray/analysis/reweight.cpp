#include "scintray/analysis/reweight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace scintray::analysis {

namespace {

using As = WantedProperty::As;

constexpr double kLeastEffective = 100.0, kLeastShare = 0.1, kLargestShare = 0.02, kHeaviestTail = 0.5;
/// Minimum number of weights that define a tail.
constexpr std::size_t kLeastTail = 10;

void check_change(const OpticalChange& change) {
  if (change.traced_absorption_per_mm.size() != change.absorption_per_mm.size() ||
      change.traced_reflectance.size() != change.reflectance.size())
    throw std::invalid_argument("traced and target optics differ in number");
  for (const WantedProperty& wanted : change.absorption_per_mm)
    if (!(wanted.value >= 0.0 && std::isfinite(wanted.value)))
      throw std::invalid_argument("an absorption is 0 or more and finite");
  for (std::size_t i = 0; i < change.reflectance.size(); ++i) {
    const WantedProperty& wanted = change.reflectance[i];
    const double most =
        wanted.as == As::times ? wanted.value * change.traced_reflectance[i].most : wanted.value;
    if (wanted.as != As::traced && !(wanted.value >= 0.0 && most <= 1.0))
      throw std::invalid_argument("a reflectance is from 0 to 1");
  }
}

/// True when the target absorption is below the traced one at some wavelength.
bool less_absorption(const WantedProperty& wanted, const tally::TracedRange& traced) {
  return (wanted.as == As::constant && wanted.value < traced.most) ||
         (wanted.as == As::times && wanted.value < 1.0 && traced.most > 0.0);
}

/// Greatest ratio of the target reflectance to the traced one.
double greatest_ratio(const WantedProperty& wanted, const tally::TracedRange& traced) {
  if (wanted.as == As::traced) return 1.0;
  if (wanted.as == As::times) return wanted.value;
  if (wanted.value == 0.0) return 0.0;
  return traced.least > 0.0 ? wanted.value / traced.least : std::numeric_limits<double>::infinity();
}

}  // namespace

Reweighting::Reweighting(OpticalChange change, std::uint64_t detected) : change_(std::move(change)) {
  check_change(change_);
  for (std::size_t i = 0; i < change_.absorption_per_mm.size(); ++i)
    gains_ = gains_ || less_absorption(change_.absorption_per_mm[i], change_.traced_absorption_per_mm[i]);
  for (std::size_t i = 0; i < change_.reflectance.size(); ++i) {
    log_wanted_.push_back(std::log(change_.reflectance[i].value));
    greatest_step_ =
        std::max(greatest_step_, greatest_ratio(change_.reflectance[i], change_.traced_reflectance[i]));
  }
  gains_ = gains_ || greatest_step_ > 1.0;
  const auto photons = static_cast<double>(detected);
  tail_ = gains_ ? static_cast<std::size_t>(std::min(photons / 5.0, 3.0 * std::sqrt(photons))) + 1 : 0;
}

double Reweighting::log_weight(const PhotonHistory& photon) const {
  double log = 0.0;
  for (std::size_t i = 0; i < change_.absorption_per_mm.size(); ++i) {
    const WantedProperty& wanted = change_.absorption_per_mm[i];
    const auto depth = static_cast<double>(photon.absorption_depth[i]);
    if (wanted.as == As::constant) log += depth - wanted.value * static_cast<double>(photon.path_mm[i]);
    if (wanted.as == As::times) log += depth * (1.0 - wanted.value);
  }
  for (std::size_t i = 0; i < change_.reflectance.size(); ++i) {
    const As as = change_.reflectance[i].as;
    if (as == As::traced || photon.reflections[i] == 0) continue;
    log += photon.reflections[i] * log_wanted_[i];
    if (as == As::constant) log += static_cast<double>(photon.reflection_depth[i]);
  }
  return log;
}

void Reweighting::keep_largest(double log_weight) {
  if (tail_ == 0) return;
  if (largest_logs_.size() == tail_) {
    if (log_weight <= largest_logs_.front()) return;
    std::pop_heap(largest_logs_.begin(), largest_logs_.end(), std::greater<>());
    largest_logs_.pop_back();
  }
  largest_logs_.push_back(log_weight);
  std::push_heap(largest_logs_.begin(), largest_logs_.end(), std::greater<>());
}

double Reweighting::add(const PhotonHistory& photon) {
  if (photon.path_mm.size() != change_.absorption_per_mm.size() ||
      photon.absorption_depth.size() != photon.path_mm.size() ||
      photon.reflections.size() != change_.reflectance.size() ||
      photon.reflection_depth.size() != photon.reflections.size())
    throw std::invalid_argument("a photon with other media or reflectors than the optics");
  const double log = log_weight(photon), weight = std::exp(log);
  ++count_;
  sum_ += weight;
  squares_ += weight * weight;
  largest_ = std::max(largest_, weight);
  keep_largest(log);
  return weight;
}

double Reweighting::tail_shape() const {
  if (largest_logs_.empty() || std::isinf(largest_logs_.front())) return 0.0;
  const double least = largest_logs_.front();
  double sum = 0.0, next = std::numeric_limits<double>::infinity();
  std::size_t above = 0;
  for (const double log : largest_logs_) {
    if (log <= least) continue;
    sum += log - least;
    next = std::min(next, log);
    ++above;
  }
  if (above < kLeastTail) return 0.0;
  // Weights of few reflections come in steps: the tail begins in the middle of one.
  return sum / static_cast<double>(above) - 0.5 * (next - least);
}

std::string Reweighting::objection(const Reweighted& result, double cut_share) const {
  for (std::size_t i = 0; i < change_.reflectance.size(); ++i) {
    const WantedProperty& wanted = change_.reflectance[i];
    if (wanted.as == As::constant && wanted.value > 0.0 && change_.traced_reflectance[i].least == 0.0)
      return fmt::format(
          "{} reflected nothing when traced, at some wavelength in use: no photon continues after it",
          i < change_.reflector_names.size() ? change_.reflector_names[i] : fmt::format("reflector {}", i));
  }
  if (result.effective_photons < kLeastEffective)
    return fmt::format("{:.0f} effective photons; {:.0f} are needed", result.effective_photons,
                       kLeastEffective);
  if (result.effective_share < kLeastShare)
    return fmt::format("the weights are worth {:.1f} % of the photons; {:.0f} % are needed",
                       100.0 * result.effective_share, 100.0 * kLeastShare);
  if (result.largest_share > kLargestShare)
    return fmt::format("one photon has {:.1f} % of the weight; {:.0f} % are allowed",
                       100.0 * result.largest_share, 100.0 * kLargestShare);
  if (!gains_) return {};
  const double next = largest_ * greatest_step_, next_share = next / (sum_ + next);
  if (next_share > kLargestShare)
    return fmt::format(
        "one more reflection would raise the largest weight to {:.1f} % of the sum; {:.0f} % are allowed",
        100.0 * next_share, 100.0 * kLargestShare);
  if (result.tail_shape >= kHeaviestTail)
    return fmt::format(
        "the photons of largest weight are too rare among those traced: the weights have a tail of shape "
        "{:.2f}; below {:.1f} is needed",
        result.tail_shape, kHeaviestTail);
  if (cut_share > result.detected_fraction.error)
    return fmt::format(
        "{:.2g} % of the photons were cut at the limits of the run, more than the error: their fates "
        "are not known",
        100.0 * cut_share);
  return {};
}

Reweighted Reweighting::finish(std::uint64_t emitted, double cut_share) const {
  if (emitted == 0 || emitted < count_)
    throw std::invalid_argument("fewer photons emitted than detected, or none");
  const auto photons = static_cast<double>(emitted), detected = static_cast<double>(count_);
  Reweighted result;
  result.detected_fraction = {sum_ / photons,
                              std::sqrt(std::max(0.0, squares_ - sum_ * sum_ / photons)) / photons};
  if (squares_ > 0.0) {
    result.relative = {sum_ / detected,
                       std::sqrt(std::max(0.0, squares_ - sum_ * sum_ / detected)) / detected};
    result.effective_photons = sum_ * sum_ / squares_;
    result.effective_share = result.effective_photons / detected;
    result.largest_share = largest_ / sum_;
    result.tail_shape = tail_shape();
  }
  result.reason = objection(result, cut_share);
  result.valid = result.reason.empty();
  return result;
}

}  // namespace scintray::analysis
