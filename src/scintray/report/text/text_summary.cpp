#include "scintray/report/text/text_summary.hpp"

#include <algorithm>

#include "scintray/report/acceptance.hpp"
#include "scintray/report/pages/detail/sections.hpp"
#include "scintray/report/pages/event_section.hpp"
#include "scintray/report/plots/detail/light_curves.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/report/text/until_text.hpp"

namespace scintray::report {

namespace {

using namespace report;
using Table = std::vector<std::vector<std::string>>;

/// Columns that fit a terminal.
constexpr std::size_t kMostColumns = 6;

std::string sweep_table(const tally::RunResult& run, const SweepView& view) {
  Table table{{view.key}};
  for (const SweepSeries& series : view.series)
    table[0].push_back(series.label.empty() ? "detected fraction" : series.label);
  for (std::size_t r = 0; r < view.rows.size(); ++r) {
    std::vector<std::string> row{view.rows[r]};
    for (const SweepSeries& series : view.series) {
      const auto found = std::find(series.x.begin(), series.x.end(), view.row_values[r]);
      row.push_back(
          found == series.x.end()
              ? "-"
              : with_error(
                    run.points[series.points[static_cast<std::size_t>(found - series.x.begin())]].fraction(
                        core::Fate::detected)));
    }
    table.push_back(std::move(row));
  }
  const bool named = view.series.size() > 1 || !view.series.front().label.empty();
  return (named ? "Detected fraction\n" : "") + aligned(table);
}

std::string point_table(const tally::RunResult& run) {
  Table table{{"point", "detected fraction"}};
  for (const tally::PointResult& point : run.points)
    table.push_back({point_label(point), with_error(point.fraction(core::Fate::detected))});
  return aligned(table);
}

std::string fate_table(const tally::PointResult& point) {
  Table table{{"fate", point.birth_efficiency < 1.0 ? "photons traced" : "photons", "fraction"}};
  for (int i = 0; i < core::kFateCount; ++i) {
    const core::Fate fate = core::fate_at(i);
    table.push_back({fate_text(fate), std::to_string(point.count(fate)), with_error(point.fraction(fate))});
  }
  table.push_back({"all", std::to_string(point.photons), ""});
  std::string traced;
  if (point.birth_efficiency < 1.0)
    traced = "Traced are " + std::to_string(point.photons) + " of " + std::to_string(point.emitted) +
             " photons: no sensor converts more than " + compact(point.birth_efficiency, 4) +
             " of them, and that share was drawn at birth. Fractions are of all photons.\n";
  return aligned(table) + traced + omission_sentence(point.omitted, Figure::fraction) + "\n";
}

std::string warnings(const tally::RunResult& run) {
  std::uint64_t lost = 0;
  double bias = 0.0;
  for (const tally::PointResult& point : run.points) {
    lost += point.lost;
    bias = std::max(bias, point.cut_bias_bound());
  }
  std::string text;
  if (bias > 0.0) text += "Cut photons may bias a fraction by at most " + compact(bias, 2) + ".\n";
  text +=
      lost == 0 ? "Lost photons: 0.\n" : "LOST PHOTONS: " + std::to_string(lost) + ". This is a defect.\n";
  if (!run.complete())
    text += "PARTIAL RESULT: " +
            (run.partial_reason.empty() ? "not every point is finished" : run.partial_reason) + ".\n";
  return text;
}

/// Why each point ended, where [run] until is stated.
std::string until_lines(const tally::RunResult& run) {
  std::string text;
  for (const tally::PointResult& point : run.points) {
    const std::string sentence = until_sentence(point);
    if (sentence.empty()) continue;
    text += (run.points.size() > 1 ? point_label(point) + ": " : "") + sentence + "\n";
  }
  return text;
}

/// Text of the events of a point: their energies and analyses.
std::string energy_lines(const tally::PointResult& point) {
  const tally::EnergyBalance& energy = point.energy;
  if (energy.events_requested == 0) return "";
  std::string text = std::to_string(energy.events) + " events";
  // A list of photons has no energies.
  if (energy.silent > 0 || energy.deposited > 0.0 || energy.non_scintillating > 0.0)
    text += ", " + std::to_string(energy.silent) +
            " of them without energy in a scintillator; keV deposited " + compact(energy.deposited, 6) +
            ", escaped " + compact(energy.escaped, 6) + ", in non-scintillating parts " +
            compact(energy.non_scintillating, 6);
  text += "\n";
  if (energy.detected.count > 0)
    text += "detected per event " + with_error(energy.detected.mean()) + " photons\n";
  return text;
}

}  // namespace

std::string text_summary(const tally::RunResult& run, const RunAnalysis& analyses) {
  if (run.points.empty()) return "No point was finished.\n" + warnings(run);
  if (run.points.size() == 1)
    return (run.traced_photons() ? fate_table(run.points.front()) : "") +
           shift_lines(run.header, run.points.front()) + tally_lines(run.header, run.points.front()) +
           energy_lines(run.points.front()) +
           (analyses.points.empty() ? "" : event_lines(analyses.points.front(), run.points.front().omitted)) +
           criterion_lines(evaluate(run, analyses)) + until_lines(run) + warnings(run);
  const auto view = view_sweep(run);
  const std::string table =
      !view ? point_table(run)
      : analyses.points.size() == run.points.size()
          ? "Light of events at 511 keV\n" +
                aligned(upright(light_table(*view, analyses.points, analyses.reference), kMostColumns))
          : sweep_table(run, *view);
  const std::string omitted = omission_sentence(omitted_anywhere(run), Figure::fraction) + "\n";
  return table + omitted + criterion_lines(evaluate(run, analyses)) + until_lines(run) + warnings(run);
}

}  // namespace scintray::report
