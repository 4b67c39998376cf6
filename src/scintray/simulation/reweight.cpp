#include "scintray/simulation/reweight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scintray/analysis/ratio.hpp"
#include "scintray/analysis/reweight.hpp"
#include "scintray/core/activity.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::simulation {

namespace {

constexpr std::uint64_t kRowsAtOnce = 65'536;

/// Photons that events emitted, by point and event; empty for a source of photons.
std::vector<std::map<std::uint64_t, double>> emitted_by_event(const std::filesystem::path& path,
                                                              std::size_t points) {
  std::vector<std::map<std::uint64_t, double>> emitted(points);
  const std::uint64_t listed = results::read_results_status(path).listed_events;
  for (std::uint64_t row = 0; row < listed; row += kRowsAtOnce)
    for (const tally::EventRecord& event :
         results::read_events(path, row, kRowsAtOnce, results::EventDetail::numbers))
      if (event.point < points) emitted[event.point][event.event] = static_cast<double>(event.emitted);
  return emitted;
}

/// The sum of weights of the current event, and sums over the previous events.
struct EventSums {
  double weight = 0.0;
  core::Moments light;               ///< of events with detected photons
  analysis::RatioOfSums of_emitted;  ///< light over emitted photons, all events that emitted any
  analysis::RatioOfSums of_traced;   ///< light over detected photons as traced
};

/// One point with all combinations of values, photon by photon.
class PointReweighting {
 public:
  PointReweighting(const tally::PointResult& point, std::vector<analysis::Reweighting> choices,
                   std::map<std::uint64_t, double> emitted)
      : point_(point), choices_(std::move(choices)), sums_(choices_.size()), emitted_(std::move(emitted)) {}

  void add(std::uint64_t event, const analysis::PhotonHistory& photon) {
    if (energy() && under_way_ && event != event_) end_event();
    event_ = event;
    under_way_ = true;
    ++detected_;
    for (std::size_t i = 0; i < choices_.size(); ++i) sums_[i].weight += choices_[i].add(photon);
  }

  std::vector<ReweightedPoint> finish(std::size_t number, const std::vector<std::vector<double>>& values) {
    if (energy()) end_events();
    std::vector<ReweightedPoint> results;
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      ReweightedPoint result;
      result.point = number;
      result.values = values[i];
      result.traced_fraction = point_.fraction(core::Fate::detected);
      result.light = choices_[i].finish(std::max<std::uint64_t>(1, point_.photons), point_.cut_bias_bound());
      if (energy()) add_events(sums_[i], result);
      results.push_back(std::move(result));
    }
    return results;
  }

 private:
  bool energy() const { return point_.energy.events_requested > 0; }

  void end_event() {
    const auto known = emitted_.find(event_);
    for (EventSums& sums : sums_) {
      sums.light.add(sums.weight);
      sums.of_emitted.add(known == emitted_.end() ? 0.0 : known->second, sums.weight);
      sums.of_traced.add(detected_, sums.weight);
      sums.weight = 0.0;
    }
    traced_.add(known == emitted_.end() ? 0.0 : known->second, detected_);
    if (known != emitted_.end()) emitted_.erase(known);
    detected_ = 0.0;
  }

  void end_events() {
    if (under_way_) end_event();
    for (const auto& [event, emitted] : emitted_) {  // without detected photons
      if (emitted == 0.0) continue;
      traced_.add(emitted, 0.0);
      for (EventSums& sums : sums_) sums.of_emitted.add(emitted, 0.0);
    }
  }

  void add_events(const EventSums& sums, ReweightedPoint& result) const {
    result.traced_fraction = traced_.ratio();
    result.light.detected_fraction = sums.of_emitted.ratio();
    result.light.relative = sums.of_traced.ratio();
    result.traced_per_event = point_.energy.detected.mean();
    core::Moments light = sums.light;
    light.count = std::max(light.count, point_.energy.detected.count);  // the others have no light
    result.per_event = light.mean();
  }

  const tally::PointResult& point_;
  std::vector<analysis::Reweighting> choices_;
  std::vector<EventSums> sums_;
  std::map<std::uint64_t, double> emitted_;
  analysis::RatioOfSums traced_;
  std::uint64_t event_ = 0;
  bool under_way_ = false;
  double detected_ = 0.0;
};

/// Row `row` of a block.
analysis::PhotonHistory history_at(const tally::PhotonHistories& rows, std::size_t row,
                                   const results::HistoryColumns& columns) {
  const auto part = [&](const auto& column, std::size_t width) {
    return std::span(column).subspan(row * width, width);
  };
  return {part(rows.path_mm, columns.media.size()), part(rows.absorption_depth, columns.media.size()),
          part(rows.reflections, columns.reflectors.size()),
          part(rows.reflection_depth, columns.reflectors.size())};
}

}  // namespace

std::vector<ReweightedPoint> reweight_results(const std::filesystem::path& path, const tally::RunResult& run,
                                              const std::vector<PropertyScan>& scans) {
  const results::HistoryReader histories(path);
  const ReweightPlan plan(path, run, histories.columns(), scans);
  std::vector<std::map<std::uint64_t, double>> emitted = emitted_by_event(path, run.points.size());
  std::vector<ReweightedPoint> results;
  tally::PhotonHistories rows;
  std::uint64_t all = 0;  // histories of the file
  for (std::size_t number = 0; number < run.points.size(); ++number)
    if (histories.traced(number)) all += run.points[number].count(core::Fate::detected);
  std::uint64_t offset = 0;  // of `rows`
  std::size_t row = 0;       // in `rows`
  const auto more = [&] {
    if (row < rows.rows()) return true;
    offset += rows.rows();
    core::report_activity("reweighting photons", offset, all);
    rows = histories.read(offset, kRowsAtOnce);
    row = 0;
    return rows.rows() > 0;
  };
  for (std::size_t number = 0; number < run.points.size(); ++number) {
    const auto traced = histories.traced(number);
    if (!traced) continue;
    const tally::PointResult& point = run.points[number];
    const std::uint64_t detected = point.count(core::Fate::detected);
    std::vector<analysis::Reweighting> choices;
    for (const std::vector<double>& choice : plan.choices())
      choices.emplace_back(plan.change(*traced, choice), detected);
    PointReweighting reweighting(point, std::move(choices), std::move(emitted[number]));
    std::uint64_t seen = 0;
    for (; more() && rows.point[row] == number; ++row, ++seen)
      reweighting.add(rows.event[row], history_at(rows, row, histories.columns()));
    if (seen != detected)
      throw results::format::damaged(path,
                                     fmt::format("{} histories for {} detected photons", seen, detected));
    for (ReweightedPoint& result : reweighting.finish(number, plan.choices()))
      results.push_back(std::move(result));
  }
  return results;
}

}  // namespace scintray::simulation
