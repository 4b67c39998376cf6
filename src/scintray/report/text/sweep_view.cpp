#include "scintray/report/text/sweep_view.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "scintray/core/text.hpp"
#include "scintray/core/value_text.hpp"

namespace scintray::report {

namespace {

bool numeric(const tally::RunResult& run, std::size_t key) {
  std::set<std::string> units;
  std::set<double> values;
  for (const tally::PointResult& point : run.points) {
    const auto q = core::value_of_text(point.parameters.at(key));
    if (!q) return false;
    units.insert(q->unit);
    values.insert(q->value);
  }
  return units.size() == 1 && values.size() >= 2;
}

/// All values but the one at `left_out`; all when that is their number.
std::string list_without(std::vector<std::string> values, std::size_t left_out) {
  if (left_out < values.size()) values.erase(values.begin() + static_cast<std::ptrdiff_t>(left_out));
  return core::list_of(values);
}

}  // namespace

std::optional<SweepView> view_sweep(const tally::RunResult& run) {
  std::size_t key = run.header.sweep_keys.size();
  while (key > 0 && !numeric(run, key - 1)) --key;
  if (key-- == 0) return std::nullopt;
  SweepView view;
  view.key = run.header.sweep_keys[key];
  std::map<double, std::string> rows;
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    const auto& parameters = run.points[i].parameters;
    const core::ValueText q = *core::value_of_text(parameters[key]);
    view.unit = q.unit;
    rows.emplace(q.value, parameters[key]);
    const std::string label = list_without(parameters, key);
    auto found =
        std::find_if(view.series.begin(), view.series.end(), [&](const auto& s) { return s.label == label; });
    if (found == view.series.end()) found = view.series.insert(found, SweepSeries{label, {}, {}});
    const auto place = std::upper_bound(found->x.begin(), found->x.end(), q.value) - found->x.begin();
    found->x.insert(found->x.begin() + place, q.value);
    found->points.insert(found->points.begin() + place, i);
  }
  for (const auto& [value, text] : rows) {
    view.row_values.push_back(value);
    view.rows.push_back(text);
  }
  return view;
}

std::string point_label(const tally::PointResult& point) {
  const std::string label = list_without(point.parameters, point.parameters.size());
  return label.empty() ? "run" : label;
}

}  // namespace scintray::report
