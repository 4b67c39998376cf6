#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/detail/goal_watch.hpp"

namespace scintray::simulation::detail {

namespace {

using scene_file::UntilGoal;

/// Photons, or events, below which the relative error of a count is not known well enough to end by it.
constexpr double kLeastCounted = 100.0;
constexpr std::uint64_t kLeastEvents = 32;
/// Pairs of events below which no run ends by the error of a CTR.
constexpr std::size_t kLeastPairs = 50;

[[noreturn]] void refuse_bin(const scene_file::UntilSpec& until, const std::string& what,
                             const std::string& hint) {
  throw core::InputError({until.tally.where, "tally \"" + until.tally.name + "\": " + what, hint});
}

/// The bin of an axis that holds a value, or has a name.
std::size_t bin_of(const scene_file::UntilSpec& until, const tally::TallyAxis& axis,
                   core::Dimension dimension, const std::string& entry) {
  if (!axis.names.empty()) {
    const auto found = std::find(axis.names.begin(), axis.names.end(), entry);
    if (found != axis.names.end()) return static_cast<std::size_t>(found - axis.names.begin());
    throw core::unknown_name(until.tally.where, "bin", entry, axis.names);
  }
  double value = 0.0;
  try {
    value = core::parse_quantity(entry, dimension);
  } catch (const core::InputError& error) {
    const core::Problem& problem = error.problems().front();
    refuse_bin(until, axis.variable + ": " + problem.what, problem.hint);
  }
  const std::vector<double>& edges = axis.edges;
  if (!(value >= edges.front() && value < edges.back()))
    refuse_bin(until, fmt::format("{} is not among its values of {}", entry, axis.variable),
               fmt::format("name a value from {:g} to {:g} {}", edges.front(), edges.back(),
                           axis.unit == "1" ? "" : axis.unit));
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), value) - edges.begin()) - 1;
}

std::string bin_text(const scene_file::UntilSpec& until) {
  std::string text = "tally " + until.tally.name;
  for (std::size_t i = 0; i < until.bin.size(); ++i) text += (i == 0 ? ", bin " : ", ") + until.bin[i];
  return text;
}

/// Setup of the analyses that a result of events needs: light, photopeak and timing.
analysis::AnalysisSetup setup_of(const SimulationPoint& point) {
  analysis::AnalysisSetup setup = analysis_setup(scene_file::AnalysisSpec(), point.plan().channels.list, {});
  setup.photopeak.window = point.spec().analysis.photopeak;
  setup.photopeak_only = point.spec().analysis.photopeak_only;
  return setup;
}

std::optional<core::Estimate> known(const core::Estimate& estimate) {
  return estimate.error > 0.0 ? std::optional(estimate) : std::nullopt;
}

}  // namespace

std::optional<TallyBin> goal_bin(const scene_file::UntilSpec& until, const tally::TallyPlan& plan) {
  if (until.of != UntilGoal::tally) return std::nullopt;
  std::vector<std::string> names;
  for (const tally::CountRequest& count : plan.counts) names.push_back(count.empty.name);
  const auto named = std::find(names.begin(), names.end(), until.tally.name);
  if (named == names.end()) throw core::unknown_name(until.tally.where, "tally", until.tally.name, names);
  const auto number = static_cast<std::size_t>(named - names.begin());
  const tally::CountRequest& count = plan.counts[number];
  const std::vector<tally::TallyAxis>& axes = count.empty.axes;
  if (until.bin.empty() && count.empty.bins() == 1) return TallyBin{number, 0};
  if (until.bin.size() != axes.size()) {
    std::string variables;
    for (const tally::TallyAxis& axis : axes) variables += (variables.empty() ? "" : ", ") + axis.variable;
    refuse_bin(until,
               fmt::format("it has {} axes, but \"bin\" has {} entries", axes.size(), until.bin.size()),
               "name a bin by a value or a name for each axis: " + variables);
  }
  std::size_t bin = 0;
  for (std::size_t i = 0; i < axes.size(); ++i)
    bin = bin * axes[i].bins() + bin_of(until, axes[i], count.axes[i].variable->dimension, until.bin[i]);
  return TallyBin{number, bin};
}

GoalWatch::GoalWatch(const SimulationPoint& point)
    : until_(*point.spec().run.until),
      birth_efficiency_(point.settings().birth_efficiency),
      bin_(goal_bin(until_, point.plan())) {
  if (scene_file::is_of_events(until_.of)) events_.emplace(setup_of(point));
  switch (until_.of) {
    case UntilGoal::fate:
      name_ = std::string("share ") + core::fate_name(until_.fate);
      break;
    case UntilGoal::tally:
      name_ = bin_text(until_);
      break;
    case UntilGoal::photopeak:
      name_ = "photopeak";
      unit_ = point.spec().readout ? "photoelectrons" : "photons";
      break;
    case UntilGoal::energy_resolution:
      name_ = "energy resolution";
      break;
    case UntilGoal::light_per_energy:
      name_ = "light per energy";
      unit_ = "1/keV";
      break;
    case UntilGoal::ctr:
      name_ = "CTR";
      unit_ = "ns";
      break;
  }
}

void GoalWatch::add(const std::vector<tally::EventRecord>& events) {
  if (events_)
    for (const tally::EventRecord& event : events) events_->add(event);
}

std::optional<core::Estimate> GoalWatch::estimate_of_events() const {
  const analysis::EventAnalysis analysis = events_->finish_figures();
  switch (until_.of) {
    case UntilGoal::photopeak:
      return analysis.peak.locates_peak() ? known(analysis.peak.fit.position) : std::nullopt;
    case UntilGoal::energy_resolution:
      return analysis.peak.locates_peak() ? known(analysis.peak.fit.relative_fwhm) : std::nullopt;
    case UntilGoal::light_per_energy:
      return known(analysis.light_per_keV);
    default:
      return analysis.pair_difference_ns && analysis.pair_difference_ns->count >= kLeastPairs
                 ? known(analysis::quoted_fwhm(*analysis.pair_difference_ns))
                 : std::nullopt;
  }
}

std::optional<core::Estimate> GoalWatch::estimate(const tally::PointSums& sums) const {
  if (events_) return estimate_of_events();
  const std::uint64_t photons = sums.counts.photons;
  if (photons == 0) return std::nullopt;
  if (!bin_) {
    tally::PointResult counts = sums.counts;
    counts.birth_efficiency = birth_efficiency_;
    return counts.fraction(until_.fate);
  }
  tally::TallyResult bins = sums.tallies[bin_->tally].value();
  tally::PointResult counts = sums.counts;
  counts.energy = sums.energy.value();
  bins.events = counts.event_counts();
  const core::Estimate score = bins.per_photon(bin_->bin, photons);
  return core::Estimate{birth_efficiency_ * score.value, birth_efficiency_ * score.error};
}

bool GoalWatch::is_known(const tally::PointSums& sums) const {
  if (sums.counts.event_fates.events > 0 && sums.counts.event_fates.events < kLeastEvents) return false;
  if (events_) return true;  // its estimate is not there while it is not known
  if (!bin_) return static_cast<double>(sums.counts.count(until_.fate)) >= kLeastCounted;
  const tally::TallyResult bins = sums.tallies[bin_->tally].value();
  const double sum = bins.sum[bin_->bin], squares = bins.sum_of_squares[bin_->bin];
  return squares > 0.0 && sum * sum / squares >= kLeastCounted;  // effective number of contributions
}

}  // namespace scintray::simulation::detail
