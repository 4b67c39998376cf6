#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scintray/simulation/detail/until_watch.hpp"

namespace scintray::simulation::detail {

namespace {

constexpr std::uint64_t kFirstPhotonBlocks = 4, kFirstEvents = 32, kGrowthDivisor = 10;

constexpr const char* kRelativeError = "relative_error";
constexpr const char* kAbsoluteError = "absolute_error";
constexpr const char* kWallTime = "wall_time";

bool is_error(const tally::UntilCondition& condition) {
  return condition.quantity == kRelativeError || condition.quantity == kAbsoluteError;
}

/// Factor by which the work has to grow to reach the goal of a condition; infinite where it is not known.
double work_factor(const tally::UntilCondition& condition) {
  const double ratio = is_error(condition) ? std::pow(condition.reached / condition.goal, 2)
                                           : condition.goal / condition.reached;
  return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity();
}

}  // namespace

std::uint64_t next_decision(std::uint64_t blocks, bool has_energy) {
  std::uint64_t next = has_energy ? kFirstEvents : kFirstPhotonBlocks;
  while (next <= blocks) next += std::max<std::uint64_t>(1, next / kGrowthDivisor);
  return next;
}

UntilWatch::UntilWatch(const SimulationPoint& point, double seconds)
    : spec_(*point.spec().run.until),
      goal_(point),
      has_energy_(point.source().has_energy()),
      work_(point.work()),
      seconds_(seconds),
      expected_(work_) {}

bool UntilWatch::is_due(std::uint64_t blocks) const {
  return blocks > 0 &&
         (next_decision(blocks - 1, has_energy_) == blocks || (spec_.wall_time_s && elapsed_s() >= seconds_));
}

void UntilWatch::look(std::uint64_t blocks, const tally::PointSums& sums) {
  if (ended_ || !is_due(blocks)) return;
  last_ = result(sums);
  const bool decides = next_decision(blocks - 1, has_energy_) == blocks;
  const bool is_known = goal_.is_known(sums);
  // An absolute error may be small because nothing was counted, which a source of photons allows for.
  const bool enough_events = !has_energy_ || sums.counts.event_fates.events >= kFirstEvents;
  double factor = std::numeric_limits<double>::infinity();
  for (tally::UntilCondition& condition : last_.conditions) {
    const bool reached = is_error(condition) ? condition.reached <= condition.goal  // false for NaN
                                             : condition.reached >= condition.goal;
    if (condition.quantity == kWallTime)
      condition.met = reached;
    else if (condition.quantity == kRelativeError)
      condition.met = decides && reached && is_known;
    else if (condition.quantity == kAbsoluteError)
      condition.met = decides && reached && enough_events;
    else
      condition.met = decides && reached;
    ended_ = ended_ || condition.met;
    factor = std::min(factor, work_factor(condition));
  }
  const double done = static_cast<double>(has_energy_ ? sums.energy.events : sums.counts.emitted);
  const double needed = std::min(done * (ended_ ? 1.0 : std::max(1.0, factor)), static_cast<double>(work_));
  expected_ = static_cast<std::uint64_t>(needed);
}

std::string UntilWatch::error_text() const {
  for (const tally::UntilCondition& condition : last_.conditions) {
    if (!is_error(condition) || !std::isfinite(condition.reached)) continue;
    if (condition.quantity == kRelativeError)
      return fmt::format("error {:.2g} %, goal {:.2g} %", 100.0 * condition.reached, 100.0 * condition.goal);
    const std::string unit = last_.unit == "1" ? "" : " " + last_.unit;
    return fmt::format("error {:.2g}{}, goal {:.2g}{}", condition.reached, unit, condition.goal, unit);
  }
  return "";
}

tally::UntilResult UntilWatch::result(const tally::PointSums& sums) const {
  if (ended_ && !last_.conditions.empty()) return last_;
  tally::UntilResult made;
  made.fate = spec_.fate;
  if (spec_.of != scene_file::UntilGoal::fate) {
    made.of = goal_.name();
    made.unit = goal_.unit();
  }
  constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  std::optional<core::Estimate> estimate;
  if (spec_.relative_error || spec_.absolute_error) estimate = goal_.estimate(sums);
  const auto add = [&](const char* quantity, const auto& goal, double reached) {
    if (goal) made.conditions.push_back({quantity, static_cast<double>(*goal), reached, false});
  };
  add(kRelativeError, spec_.relative_error,
      estimate && estimate->value > 0.0 ? estimate->error / estimate->value : kNotKnown);
  add(kAbsoluteError, spec_.absolute_error, estimate ? estimate->error : kNotKnown);
  if (spec_.wall_time_s) made.conditions.push_back({kWallTime, seconds_, elapsed_s(), false});
  add("photons", spec_.photons, static_cast<double>(sums.counts.emitted));
  add("events", spec_.events, static_cast<double>(sums.energy.events));
  return made;
}

std::vector<double> time_shares(const std::vector<double>& seconds, const std::vector<double>& errors) {
  const auto points = static_cast<double>(seconds.size());
  double known = 0.0, sum = 0.0;
  for (const double error : errors)
    if (error > 0.0 && std::isfinite(error)) {
      ++known;
      sum += error * error;
    }
  std::vector<double> shares;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const bool has_error = errors[i] > 0.0 && std::isfinite(errors[i]);
    const double square = has_error ? errors[i] * errors[i] : known > 0.0 ? sum / known : 1.0;
    shares.push_back(seconds[i] * square);
  }
  const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share = total > 0.0 ? share / total : 1.0 / points;
  return shares;
}

}  // namespace scintray::simulation::detail
