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
