#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/simulation/detail/until_watch.hpp"

namespace scintray::simulation::detail {

namespace {

constexpr std::uint64_t kFirstPhotonBlocks = 4, kFirstEvents = 32, kGrowthDivisor = 10;
/// Photons of the fate, below which their relative error is not known well enough to end by it.
constexpr std::uint64_t kLeastOfFate = 100;

constexpr const char* kRelativeError = "relative_error";
constexpr const char* kAbsoluteError = "absolute_error";
constexpr const char* kWallTime = "wall_time";

/// Factor by which the work has to grow to reach the goal of a condition; infinite where it is not known.
double work_factor(const tally::UntilCondition& condition) {
  const bool is_error = condition.quantity == kRelativeError || condition.quantity == kAbsoluteError;
  const double ratio =
      is_error ? std::pow(condition.reached / condition.goal, 2) : condition.goal / condition.reached;
  return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity();
}

}  // namespace

std::uint64_t next_decision(std::uint64_t blocks, bool has_energy) {
  std::uint64_t next = has_energy ? kFirstEvents : kFirstPhotonBlocks;
  while (next <= blocks) next += std::max<std::uint64_t>(1, next / kGrowthDivisor);
  return next;
}

UntilWatch::UntilWatch(const scene_file::UntilSpec& spec, const RunOutline& run, std::size_t point,
                       double seconds, double birth_efficiency)
    : spec_(spec),
      has_energy_(run.has_energy),
      work_(run.points[point].work),
      seconds_(seconds),
      birth_efficiency_(birth_efficiency),
      expected_(work_) {}

bool UntilWatch::is_due(std::uint64_t blocks) const {
  return blocks > 0 &&
         (next_decision(blocks - 1, has_energy_) == blocks || (spec_.wall_time_s && elapsed_s() >= seconds_));
}

void UntilWatch::look(std::uint64_t blocks, const tally::PointSums& sums) {
  if (ended_ || blocks == 0) return;
  last_ = result(sums);
  const bool decides = next_decision(blocks - 1, has_energy_) == blocks;
  const tally::EventFates& events = sums.counts.event_fates;
  const bool known_error = !has_energy_ || events.events >= kFirstEvents;
  double factor = std::numeric_limits<double>::infinity();
  for (tally::UntilCondition& condition : last_.conditions) {
    if (condition.quantity == kWallTime)
      condition.met = condition.reached >= condition.goal;
    else if (condition.quantity == kRelativeError)
      condition.met = decides && known_error && condition.reached <= condition.goal &&
                      sums.counts.count(spec_.fate) >= kLeastOfFate;
    else if (condition.quantity == kAbsoluteError)
      condition.met = decides && known_error && condition.reached <= condition.goal;
    else
      condition.met = decides && condition.reached >= condition.goal;
    ended_ = ended_ || condition.met;
    factor = std::min(factor, work_factor(condition));
  }
  const double done = static_cast<double>(has_energy_ ? sums.energy.events : sums.counts.emitted);
  const double needed = std::min(done * (ended_ ? 1.0 : std::max(1.0, factor)), static_cast<double>(work_));
  expected_ = static_cast<std::uint64_t>(needed);
}

tally::UntilResult UntilWatch::result(const tally::PointSums& sums) const {
  if (ended_ && !last_.conditions.empty()) return last_;
  tally::UntilResult made;
  made.fate = spec_.fate;
  tally::PointResult counts = sums.counts;
  counts.birth_efficiency = birth_efficiency_;
  const core::Estimate share = counts.fraction(spec_.fate);
  const auto add = [&](const char* quantity, const auto& goal, double reached) {
    if (goal) made.conditions.push_back({quantity, static_cast<double>(*goal), reached, false});
  };
  add(kRelativeError, spec_.relative_error,
      share.value > 0.0 ? share.error / share.value : std::numeric_limits<double>::quiet_NaN());
  add(kAbsoluteError, spec_.absolute_error,
      counts.photons > 0 ? share.error : std::numeric_limits<double>::quiet_NaN());
  if (spec_.wall_time_s) made.conditions.push_back({kWallTime, seconds_, elapsed_s(), false});
  add("photons", spec_.photons, static_cast<double>(counts.emitted));
  add("events", spec_.events, static_cast<double>(sums.energy.events));
  return made;
}

}  // namespace scintray::simulation::detail
