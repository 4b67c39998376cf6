#include "scintray/tally/result.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::tally {

std::size_t TallyResult::bins() const {
  std::size_t bins = 1;
  for (const TallyAxis& axis : axes) bins *= axis.bins();
  return bins;
}

core::Estimate TallyResult::at(std::size_t bin, std::uint64_t photons) const {
  if (photons == 0) return {};
  const double n = static_cast<double>(photons);
  // Sum of n independent scores: n times their variance, which is at least that of one count.
  const double variance = std::max(sum_of_squares[bin] - sum[bin] * sum[bin] / n, 0.0);
  const bool counts = score == scene_file::kPhotonScore && sum[bin] == 0.0;
  return {sum[bin], counts ? 1.0 : std::sqrt(variance)};
}

core::Estimate TallyResult::per_photon(std::size_t bin, std::uint64_t photons) const {
  const core::Estimate total = at(bin, photons);
  const double n = std::max(1.0, static_cast<double>(photons));
  return {total.value / n, total.error / n};
}

optics::ShiftCount PointResult::shifted() const {
  optics::ShiftCount total;
  for (const optics::ShiftCount& count : shifted_in_medium) total += count;
  for (const optics::ShiftCount& count : shifted_at_surface) total += count;
  return total;
}

core::Estimate PointResult::detected_fraction(std::uint64_t detected) const {
  const core::Estimate share = core::binomial_estimate(detected, photons);
  return {birth_efficiency * share.value, birth_efficiency * share.error};
}

core::Estimate PointResult::not_detected_fraction(std::uint64_t not_detected, std::uint64_t detected) const {
  if (birth_efficiency == 1.0 || photons == 0) return core::binomial_estimate(not_detected, photons);
  // The mean over the traced photons of 1 for a photon that is not detected and 1 - b for one that is.
  const double n = static_cast<double>(photons), weight = 1.0 - birth_efficiency;
  const double whole = static_cast<double>(not_detected), partial = static_cast<double>(detected);
  const double mean = (whole + weight * partial) / n;
  const double square = (whole + weight * weight * partial) / n;
  return {mean, std::sqrt(std::max(1.0 / n, square - mean * mean) / n)};
}

core::Estimate PointResult::fraction(core::Fate fate) const {
  if (fate == core::Fate::detected) return detected_fraction(count(fate));
  if (fate == core::Fate::not_detected)
    return not_detected_fraction(count(fate), count(core::Fate::detected));
  return core::binomial_estimate(count(fate), photons);
}

double PointResult::cut_bias_bound() const {
  if (photons == 0) return 0.0;
  const std::uint64_t cut = count(core::Fate::cut_interactions) + count(core::Fate::cut_time);
  return static_cast<double>(cut) / static_cast<double>(photons);
}

bool RunResult::traced_photons() const {
  return std::any_of(points.begin(), points.end(),
                     [](const PointResult& point) { return point.photons > 0; });
}

bool RunResult::complete() const {
  return partial_reason.empty() && !points.empty() &&
         std::all_of(points.begin(), points.end(), [](const PointResult& point) { return point.complete; });
}

}  // namespace scintray::tally
