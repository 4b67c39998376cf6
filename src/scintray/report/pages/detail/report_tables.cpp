#include "scintray/report/pages/detail/sections.hpp"

#include <algorithm>
#include <numeric>

#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/until_text.hpp"

namespace scintray::report {

namespace {

constexpr std::size_t kFewPoints = 4;

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

/// One fate as listed on the page, by name of its medium or surface.
struct LedgerEntry {
  std::string name;
  std::string colour;                  ///< class of the bar
  std::vector<core::Estimate> shares;  ///< of the photons, per point
  bool seen = false;                   ///< some photon had this fate
};

std::vector<LedgerEntry> ledger(const tally::RunResult& run) {
  std::vector<LedgerEntry> entries;
  const auto add = [&](const std::string& name, const std::string& colour, const auto& share) {
    LedgerEntry entry{name, colour, {}};
    for (const tally::PointResult& point : run.points) {
      entry.shares.push_back(share(point));
      entry.seen = entry.seen || entry.shares.back().value > 0.0;
    }
    entries.push_back(std::move(entry));
  };
  const auto add_fate = [&](const std::string& name, const std::string& colour, core::Fate fate) {
    add(name, colour, [fate](const tally::PointResult& point) { return point.fraction(fate); });
  };
  const auto add_absorbed = [&](const std::string& name, const std::string& colour, auto id) {
    add(name, colour, [id](const tally::PointResult& point) { return point.absorbed_fraction(id); });
  };
  add_fate("detected", "f0", core::Fate::detected);
  add_fate("not detected", "f1", core::Fate::not_detected);
  for (const core::MediumId medium : run.header.media.ids())
    add_absorbed("absorbed in " + run.header.media[medium], "f2", medium);
  for (const core::SurfaceId surface : run.header.surfaces.ids())
    add_absorbed("absorbed at " + run.header.surfaces[surface], "f3", surface);
  add_fate("escaped", "f4", core::Fate::escaped);
  add_fate("cut: interactions", "f5", core::Fate::cut_interactions);
  add_fate("cut: time", "f5", core::Fate::cut_time);
  // Media and surfaces without absorption carry no information; that none was cut does.
  std::erase_if(entries, [](const LedgerEntry& entry) { return entry.colour != "f5" && !entry.seen; });
  return entries;
}

std::string bar(const std::vector<LedgerEntry>& entries, const tally::PointResult& point, std::size_t index) {
  std::string out = "<div class=\"bar\">";
  for (const LedgerEntry& entry : entries) {
    if (entry.shares[index].value == 0.0 || point.photons == 0) continue;
    const double share = 100.0 * entry.shares[index].value;
    out += "<span class=\"" + entry.colour + "\" style=\"width:" + compact(share, 6) + "%\" title=\"" +
           escape_html(entry.name + ": " + percent_with_error(entry.shares[index])) + "\">" +
           (share > 7.0 ? fixed(share, 1) + " %" : "") + "</span>";
  }
  return out + "</div>";
}

std::string bars(const tally::RunResult& run, const std::vector<LedgerEntry>& entries) {
  std::string out = "<p class=\"key\">";
  const char* const names[] = {"detected", "not detected", "absorbed in media", "absorbed at surfaces",
                               "escaped",  "cut"};
  for (int i = 0; i < 6; ++i)
    out += "<span><i class=\"f" + std::to_string(i) + "\"></i>" + names[i] + "</span>";
  out += "</p>\n<div class=\"bars\">\n";
  for (std::size_t i = 0; i < run.points.size(); ++i)
    out += "<div class=\"who\">" + escape_html(point_label(run.points[i])) + "</div>" +
           bar(entries, run.points[i], i) + "\n";
  return out + "</div>\n";
}

std::string rate(double per_second) {
  if (per_second >= 1e6) return compact(per_second / 1e6, 3) + " million";
  if (per_second >= 1e3) return compact(per_second / 1e3, 3) + " thousand";
  return compact(per_second, 3);
}

/// The column of the sum over all entries.
constexpr const char* kSum = "sum";

/// Cells with their head row and head column.
using LedgerTable = std::vector<std::vector<std::string>>;

LedgerTable ledger_table(const tally::RunResult& run, const std::vector<LedgerEntry>& entries) {
  LedgerTable cells{{"point"}};
  for (const LedgerEntry& entry : entries) cells[0].push_back(entry.name);
  cells[0].insert(cells[0].end(), {kSum, "lost photons"});
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    const tally::PointResult& point = run.points[i];
    std::vector<std::string> row{point_label(point)};
    for (const LedgerEntry& entry : entries) {
      const core::Estimate share = entry.shares[i];
      row.push_back(share.value == 0.0 ? "0" : with_error({100.0 * share.value, 100.0 * share.error}));
    }
    double sum = 0.0;
    for (int fate = 0; fate < core::kFateCount; ++fate) sum += point.fraction(core::fate_at(fate)).value;
    row.push_back(point.photons == 0 ? "no photons" : compact(100.0 * sum, 6));
    row.push_back(grouped(point.lost));
    cells.push_back(std::move(row));
  }
  return cells;
}

LedgerTable transposed(const LedgerTable& cells) {
  LedgerTable turned(cells.front().size());
  for (const auto& row : cells)
    for (std::size_t i = 0; i < row.size(); ++i) turned[i].push_back(row[i]);
  return turned;
}

std::string table_of(const LedgerTable& cells) {
  std::string rows;
  for (std::size_t r = 1; r < cells.size(); ++r) {
    rows += cells[r].front() == kSum ? "<tr class=\"sum\">" : "<tr>";
    for (std::size_t i = 0; i < cells[r].size(); ++i)
      rows += i == 0 ? cell(cells[r][i], "th") : number_cell(cells[r][i]);
    rows += "</tr>\n";
  }
  return table(cells.front(), rows);
}

}  // namespace

std::string sweep_section(const tally::RunResult& run, const SweepView& view) {
  Plot plot;
  plot.title = "Detected fraction against " + view.key;
  plot.x_label = view.key + (view.unit.empty() ? "" : " (" + view.unit + ")");
  plot.y_label = "detected fraction";
  std::vector<std::string> head{view.key};
  for (const SweepSeries& series : view.series) {
    PlotSeries drawn{series.label, series.x, {}, {}, false};
    for (const std::size_t i : series.points) {
      const core::Estimate light = run.points[i].fraction(core::Fate::detected);
      drawn.y.push_back(light.value);
      drawn.error.push_back(light.error);
    }
    plot.series.push_back(std::move(drawn));
    head.push_back(series.label.empty() ? "detected fraction" : series.label);
  }
  std::string rows;
  for (std::size_t r = 0; r < view.rows.size(); ++r) {
    rows += "<tr>" + cell(view.rows[r], "th");
    for (const SweepSeries& series : view.series) {
      const auto found = std::find(series.x.begin(), series.x.end(), view.row_values[r]);
      const auto at = static_cast<std::size_t>(found - series.x.begin());
      rows += number_cell(found == series.x.end()
                              ? ""
                              : with_error(run.points[series.points[at]].fraction(core::Fate::detected)));
    }
    rows += "</tr>\n";
  }
  return section("Light output",
                 "<figure>" + chart(plot) +
                     "<figcaption>Fraction of photons detected. Bars show one standard error; where "
                     "none is visible it is smaller than the mark.</figcaption></figure>\n" +
                     table(head, rows));
}

std::string headline(const tally::PointResult& point) {
  return "<p class=\"headline\"><b>" + escape_html(percent_with_error(point.fraction(core::Fate::detected))) +
         "</b> of the photons were detected</p>\n" + omission_note(point.omitted, Figure::fraction);
}

std::string fate_section(const tally::RunResult& run) {
  const auto entries = ledger(run);
  const LedgerTable cells = ledger_table(run, entries);
  // A sweep extends downwards, a few points are shown side by side.
  const std::string numbers = run.points.size() > kFewPoints ? table_of(cells) : table_of(transposed(cells));
  return section("Where every photon ended",
                 bars(run, entries) +
                     "<details open=\"open\"><summary>In per cent of the photons</summary>\n" + numbers +
                     "</details>\n<p class=\"omitted\">" +
                     escape_html(omission_sentence(omitted_anywhere(run), Figure::fraction)) + "</p>\n");
}

namespace {

/// Sensors of a point from which on it is a block of sensors.
constexpr std::size_t kBlock = 4;

/// For a block of sensors that photons, not events, were shot into: why there is no flood map.
std::string no_events(const tally::RunResult& run) {
  const bool block = std::any_of(run.points.begin(), run.points.end(), [](const tally::PointResult& point) {
    return point.energy.events_requested == 0 && point.sensor_faces.size() >= kBlock;
  });
  if (!block) return "";
  return "<p>No flood map, spectrum or timing: the source emits photons, not events. An event source, as "
         "type = "
         "&quot;gamma_events&quot; in [source], has them (docs/gamma_sources.md).</p>\n";
}

/// How the detected light of a point is divided among its sensors.
std::string sensor_spread(const tally::PointResult& point) {
  if (point.sensor_faces.size() < kBlock) return "";
  std::vector<std::uint64_t> detected;
  for (const tally::SensorFaceCount& count : point.sensor_faces) detected.push_back(count.detected);
  std::sort(detected.begin(), detected.end());
  const std::uint64_t sum = total(detected);
  return "<p>" + escape_html(point_label(point)) + ": " + grouped(sum) + " photons detected by " +
         grouped(detected.size()) + " faces of sensors; a face has " + grouped(detected.front()) + " to " +
         grouped(detected.back()) + ", on average " +
         compact(static_cast<double>(sum) / static_cast<double>(detected.size()), 4) + ".</p>\n";
}

}  // namespace

std::string sensor_section(const tally::RunResult& run) {
  std::string rows, spreads;
  for (const tally::PointResult& point : run.points) {
    if (run.points.size() <= kFewPoints) spreads += sensor_spread(point);
    for (const tally::SensorFaceCount& count : point.sensor_faces)
      rows += "<tr>" + cell(point_label(point), "th") + cell(run.header.parts.at(count.part)) +
              cell(run.header.faces.at(count.face)) + number_cell(grouped(count.detected)) +
              number_cell(percent_with_error(point.detected_fraction(count))) +
              number_cell(percent_with_error(point.not_detected_fraction(count))) + "</tr>\n";
  }
  if (rows.empty()) return "";
  return section(
      "Sensors, face by face",
      spreads + table({"point", "sensor", "face", "detected", "of all photons", "not detected"}, rows, 3) +
          no_events(run));
}

std::string condition_section(const tally::RunResult& run) {
  std::uint64_t emitted = 0, photons = 0, events = 0, segments = 0, misses = 0, lost = 0;
  double seconds = 0.0, bias = 0.0;
  for (const tally::PointResult& point : run.points) {
    emitted += point.emitted;
    photons += point.photons;
    events += point.energy.events;
    segments += point.segments;
    misses += point.resolved_misses;
    lost += point.lost;
    seconds += point.wall_seconds;
    bias = std::max(bias, point.cut_bias_bound());
  }
  std::string rows;
  const auto row = [&](const std::string& name, const std::string& value) {
    rows += "<tr>" + cell(name, "th") + cell(value) + "</tr>\n";
  };
  row("ScintRay", run.header.version);
  row("scene", run.header.scene_file);
  row("seed", std::to_string(run.header.seed));
  const std::string in_points =
      " in " + grouped(run.points.size()) + (run.points.size() == 1 ? " point" : " points");
  if (run.traced_photons()) {
    row("photons", grouped(emitted) + in_points);
    if (photons < emitted)
      row("of them traced",
          grouped(photons) + ": the others were drawn at birth as photons that no sensor would convert");
    row("lost photons", grouped(lost));
    row("largest bias from cut photons",
        bias == 0.0 ? "none: no photon was cut" : compact(bias, 2) + " of a fraction");
    row("straight segments", grouped(segments) + ", " + grouped(misses) + " resolved by the exact query");
  } else {
    row("events", grouped(events) + in_points + ", without tracing photons");
  }
  for (const tally::PointResult& point : run.points)
    if (const std::string sentence = until_sentence(point); !sentence.empty())
      row(run.points.size() > 1 ? "end of " + point_label(point) : "end", sentence);
  row("time", compact(seconds, 3) + " s");
  if (seconds > 0.0)
    row("speed", run.traced_photons() ? rate(static_cast<double>(segments) / seconds) + " segments/s, " +
                                            rate(static_cast<double>(emitted) / seconds) + " photons/s"
                                      : rate(static_cast<double>(events) / seconds) + " events/s");
  std::string notes;
  if (!run.header.note.empty()) {
    notes = "<h3>Warnings</h3>\n<ul>\n";
    for (std::size_t start = 0; start < run.header.note.size();) {
      const std::size_t end = std::min(run.header.note.find('\n', start), run.header.note.size());
      if (end > start) notes += "<li>" + escape_html(run.header.note.substr(start, end - start)) + "</li>\n";
      start = end + 1;
    }
    notes += "</ul>\n";
  }
  return section("Conditions of the run", scroll_area("conditions of the run") +
                                              "<table class=\"pairs\"><tbody>\n" + rows +
                                              "</tbody></table></div>\n" + notes);
}

}  // namespace scintray::report
