#include "scintray/report/pages/detail/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/words.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/plots/detail/grid_map.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::report {

namespace {

/// Rows and columns up to which a matrix is printed as numbers.
constexpr std::size_t kMostCells = 16;
/// Rows of a table of names that are shown.
constexpr std::size_t kMostRows = 400;

/// Form of a tally where its axes do not determine it.
/// Hidden are companions of other tallies and exit angles, which have figures of their own.
enum class TallyView { by_axes, crosstalk, etendue, hemisphere, ledger, hidden };
constexpr core::Word<TallyView> kTallyViews[] = {{scene_file::kCrosstalk, TallyView::crosstalk},
                                                 {scene_file::kEtendue, TallyView::etendue},
                                                 {"angles", TallyView::hemisphere},
                                                 {"emitted", TallyView::hidden},
                                                 {"ledger", TallyView::ledger},
                                                 {scene_file::kExitAngle, TallyView::hidden},
                                                 {scene_file::kExitAngleBeyond, TallyView::hidden}};

TallyView view_of(const tally::TallyResult& tally) {
  return core::find_word(kTallyViews, tally.type).value_or(TallyView::by_axes);
}

bool is_angle(const tally::TallyAxis& axis) { return axis.unit == "rad"; }

bool is_position(const tally::TallyAxis& axis) { return axis.variable == "position"; }

/// "x (mm)" for a position along an axis of the world, else the variable with its unit.
std::string axis_label(const tally::TallyAxis& axis) {
  std::string name = axis.variable;
  static const char* const kAxes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k)
    if (is_position(axis) && axis.along[k] == 1.0) name = kAxes[k];
  std::replace(name.begin(), name.end(), '_', ' ');
  return axis.unit.empty() || axis.unit == "1" ? name
                                               : name + (is_angle(axis) ? " (deg)" : " (" + axis.unit + ")");
}

std::vector<double> edges_of(const tally::TallyAxis& axis) {
  std::vector<double> edges = axis.edges;
  if (is_angle(axis))
    for (double& edge : edges) edge /= core::kDegree;
  return edges;
}

bool both(const tally::TallyResult& tally, bool (*is)(const tally::TallyAxis&)) {
  return tally.axes.size() == 2 && is(tally.axes[0]) && is(tally.axes[1]);
}
bool is_named(const tally::TallyAxis& axis) { return !axis.names.empty(); }
bool is_number(const tally::TallyAxis& axis) { return axis.names.empty(); }

std::string light_spread_text(const tally::TallyResult& tally) {
  const analysis::LightSpread spread = analysis::light_spread(tally);
  const auto along = [&](std::size_t k) {
    return axis_label(tally.axes[k]) + ": centre " +
           with_error({spread.centre_mm[k], spread.centre_error_mm[k]}) + ", rms " +
           compact(spread.rms_mm[k], 3) + ", FWHM " + compact(spread.fwhm_mm[k], 3);
  };
  return along(0) + "; " + along(1);
}

std::string etendue_text(const tally::TallyResult& tally) {
  if (tally.index <= 0.0) return "in media of several indices: none";
  try {
    const analysis::Etendue etendue = analysis::read_etendue(tally);
    return with_error(etendue.filled_mm2_sr) + " mm2 sr filled, of " + compact(etendue.grid_mm2_sr, 4) +
           " over the whole face, in index " + compact(etendue.index, 4);
  } catch (const core::InputError& error) {
    return error.problems().front().what;
  }
}

GridMap map_of(const tally::TallyResult& tally) {
  GridMap map;
  // The first axis is to the right.
  map.columns = tally.axes[0].bins();
  map.rows = tally.axes[1].bins();
  map.values.resize(tally.sum.size());
  for (std::size_t i = 0; i < map.columns; ++i)
    for (std::size_t j = 0; j < map.rows; ++j) map.values[j * map.columns + i] = tally.sum[i * map.rows + j];
  map.x_label = axis_label(tally.axes[0]);
  map.y_label = axis_label(tally.axes[1]);
  map.alternative = tally.name;
  map.value_label = tally.score == "photons" ? "photons per cell" : tally.score + " per cell";
  if (is_named(tally.axes[0])) {
    map.x_high = static_cast<double>(map.columns);
  } else {
    map.x_low = edges_of(tally.axes[0]).front();
    map.x_high = edges_of(tally.axes[0]).back();
  }
  if (is_named(tally.axes[1])) {
    map.y_high = static_cast<double>(map.rows);
  } else {
    map.y_low = edges_of(tally.axes[1]).front();
    map.y_high = edges_of(tally.axes[1]).back();
  }
  return map;
}

/// What became of the light incident on the sensors of a ledger: rows of faces where light was detected or
/// not detected, and none went on.
std::string ledger_lines(const tally::TallyResult& tally, std::uint64_t photons) {
  std::string lines;
  const std::vector<std::string>& events = tally.axes[1].names;
  for (std::size_t face = 0; face < tally.axes[0].bins(); ++face) {
    const auto count = [&](core::StepEvent event) {
      const auto found =
          std::find(events.begin(), events.end(), core::word_of(scene_file::kEventWords, event));
      return found == events.end()
                 ? core::Estimate{}
                 : tally.at(face * events.size() + static_cast<std::size_t>(found - events.begin()), photons);
    };
    const auto any = [&](core::StepEvent event) { return count(event).value > 0.0; };
    if (!any(core::StepEvent::detected) && !any(core::StepEvent::not_detected)) continue;
    if (any(core::StepEvent::transmitted) || any(core::StepEvent::escaped)) continue;
    const core::Estimate back = count(core::StepEvent::reflected);
    const double detected = count(core::StepEvent::detected).value;
    const double lost = count(core::StepEvent::not_detected).value;
    const double in = detected + lost, all = in + back.value;
    // Of two independent sums.
    const double error = std::hypot(in * back.error, back.value * std::sqrt(in)) / (all * all);
    lines += tally.name + ": of the light incident on " + tally.axes[0].names[face] + " " +
             percent_with_error({back.value / all, error}) + " is reflected, " +
             compact(100.0 * detected / all, 3) + " % detected, " + compact(100.0 * lost / all, 3) +
             " % enters and is not detected\n";
  }
  return lines;
}

std::string names_table(const tally::TallyResult& tally, std::uint64_t photons) {
  std::string rows;
  const std::size_t shown = std::min(tally.sum.size(), kMostRows);
  for (std::size_t i = 0; i < shown; ++i)
    rows += "<tr>" + cell(tally.axes[0].names[i], "th") + number_cell(with_error(tally.at(i, photons))) +
            number_cell(with_error(tally.per_photon(i, photons))) + "</tr>\n";
  const std::string rest = shown < tally.sum.size() ? "<p>and " + std::to_string(tally.sum.size() - shown) +
                                                          " more in the results file</p>\n"
                                                    : "";
  return table({axis_label(tally.axes[0]), tally.score, "per photon"}, rows) + rest;
}

std::string crosstalk_table(const tally::PointResult& point, const tally::TallyResult& tally) {
  const analysis::Crosstalk crosstalk = analysis::read_crosstalk(point, tally.name);
  std::vector<std::string> head{"light of"};
  head.insert(head.end(), crosstalk.sensors.begin(), crosstalk.sensors.end());
  std::string rows;
  for (std::size_t i = 0; i < crosstalk.sources.size(); ++i) {
    rows += "<tr>" + cell(crosstalk.sources[i], "th");
    for (const core::Estimate& share : crosstalk.share[i]) rows += number_cell(percent_with_error(share));
    rows += "</tr>\n";
  }
  return table(head, rows);
}

std::string matrix_table(const tally::TallyResult& tally, std::uint64_t photons) {
  std::vector<std::string> head{axis_label(tally.axes[0])};
  for (std::string name : tally.axes[1].names) {
    // Step events in words, which break where a table is wide.
    if (tally.axes[1].variable == "occasion") std::replace(name.begin(), name.end(), '_', ' ');
    head.push_back(std::move(name));
  }
  std::string rows;
  const std::size_t columns = tally.axes[1].bins();
  for (std::size_t i = 0; i < std::min(tally.axes[0].bins(), kMostRows); ++i) {
    rows += "<tr>" + cell(tally.axes[0].names[i], "th");
    for (std::size_t j = 0; j < columns; ++j)
      rows += number_cell(with_error(tally.at(i * columns + j, photons)));
    rows += "</tr>\n";
  }
  return table(head, rows);
}

std::string histogram(const tally::TallyResult& tally, const tally::PointResult& point) {
  Plot plot;
  plot.title = point_label(point) + ": " + tally.name;
  plot.x_label = axis_label(tally.axes[0]);
  plot.y_label = tally.score + " per bin";
  plot.width = 560.0;
  plot.height = 300.0;
  plot.series.push_back({"", edges_of(tally.axes[0]), tally.sum, {}, true});
  return chart(plot);
}

bool is_empty(const tally::TallyResult& tally) {
  return std::all_of(tally.sum.begin(), tally.sum.end(), [](double sum) { return sum == 0.0; });
}

/// Why a tally of nothing has no map. Light spread counts where light reaches a sensor: the faces where it
/// did.
std::string nothing_counted(const tally::RunHeader& header, const tally::PointResult& point,
                            const tally::TallyResult& tally) {
  if (tally.outside > 0.0) return "nothing was counted within its axes: make them wider";
  if (tally.type != "light_spread")
    return "nothing was counted: no photon was there in the way and under the conditions that it states";
  std::vector<std::string> reached;
  for (const tally::SensorFaceCount& count : point.sensor_faces)
    if (count.detected + count.not_detected > 0) reached.push_back(header.faces.at(count.face));
  constexpr std::size_t kMostNamed = 4;
  const std::string more = reached.size() > kMostNamed ? ", ..." : "";
  reached.resize(std::min(reached.size(), kMostNamed));
  return reached.empty()
             ? "nothing was counted: no light reached a sensor"
             : "nothing was counted: light reached the sensors not through this face, but through " +
                   core::list_of(reached) + more + "; name such a face";
}

std::string drawing(const tally::RunHeader& header, const tally::TallyResult& tally,
                    const tally::PointResult& point, std::string& caption) {
  const TallyView view = view_of(tally);
  if (!tally.axes.empty() && is_empty(tally)) {
    caption += ": " + nothing_counted(header, point, tally);
    return "";
  }
  if (view == TallyView::crosstalk && tally.axes[0].bins() <= kMostCells &&
      tally.axes[1].bins() <= kMostCells) {
    caption += ". Share of the light of each row that each sensor detected.";
    return crosstalk_table(point, tally);
  }
  if (tally.axes.empty()) return "<p>" + escape_html(with_error(tally.at(0, point.emitted))) + "</p>\n";
  if (view == TallyView::etendue) {
    caption += ": " + etendue_text(tally);
    return "";
  }
  if (view == TallyView::hemisphere) {
    caption +=
        ". Seen along the normal; circles at 30, 60 and 90 deg; every cell has the same projected solid "
        "angle.";
    GridMap map = map_of(tally);
    GridMap turned = map;  // rows of polar angle, columns of azimuth
    turned.rows = map.columns;
    turned.columns = map.rows;
    turned.values = tally.sum;
    return polar_map(turned);
  }
  if (both(tally, is_position)) caption += ". " + light_spread_text(tally);
  if (both(tally, is_named) && tally.axes[1].bins() <= kMostCells) return matrix_table(tally, point.emitted);
  if (tally.axes.size() == 2) return grid_map(map_of(tally));
  if (tally.axes.size() == 1 && is_named(tally.axes[0])) return names_table(tally, point.emitted);
  if (tally.axes.size() == 1 && is_number(tally.axes[0])) return histogram(tally, point);
  caption += fmt::format(". {} axes, {} bins: in the results file.", tally.axes.size(), tally.sum.size());
  return "";
}

std::string figure(const tally::RunHeader& header, const tally::TallyResult& tally,
                   const tally::PointResult& point) {
  std::string caption = point_label(point) + ": " + tally.name;
  const std::string drawn = drawing(header, tally, point, caption);
  if (tally.outside > 0.0) caption += " " + compact(tally.outside) + " " + tally.score + " outside the axes.";
  return "<figure>" + drawn + "<figcaption>" + escape_html(caption) + "</figcaption></figure>\n";
}

}  // namespace

std::string tally_section(const tally::RunResult& run) {
  constexpr std::size_t kFewPoints = 4;
  std::string first, others;
  for (std::size_t i = 0; i < run.points.size(); ++i)
    for (const tally::TallyResult& tally : run.points[i].tallies) {
      if (view_of(tally) == TallyView::hidden) continue;
      (i < kFewPoints ? first : others) += figure(run.header, tally, run.points[i]);
    }
  if (first.empty()) return "";
  std::string body = "<div class=\"grid\">\n" + first + "</div>\n";
  if (!others.empty())
    body += "<details><summary>The other points</summary>\n<div class=\"grid\">\n" + others +
            "</div></details>\n";
  return section("Tallies", body);
}

std::string tally_lines(const tally::RunHeader& header, const tally::PointResult& point) {
  std::string lines;
  for (const analysis::CrossingAngles& tally : analysis::crossing_angles(point)) {
    const auto within = [](const std::vector<std::uint64_t>& counts, const std::vector<double>& groups) {
      const analysis::Divergence d = analysis::divergence(counts, groups);
      const auto degrees = [](const core::Estimate& e) {
        return with_error({e.value / core::kDegree, e.error / core::kDegree});
      };
      return degrees(d.half_rad) + " deg (half of the light), " + degrees(d.ninety_rad) +
             " deg (nine tenths)";
    };
    if (analysis::divergence(tally.inside).photons == 0) continue;
    lines += "divergence, " + tally.name + ": inside " + within(tally.inside, tally.inside_groups) +
             "; outside " + within(tally.outside, tally.outside_groups) + "\n";
  }
  for (const tally::TallyResult& tally : point.tallies) {
    const TallyView view = view_of(tally);
    if (view == TallyView::hidden) continue;
    if (!tally.axes.empty() && is_empty(tally))
      lines += tally.name + ": " + nothing_counted(header, point, tally) + "\n";
    else if (tally.axes.empty())
      lines += tally.name + ": " + with_error(tally.per_photon(0, point.emitted)) + " " + tally.score +
               " per photon\n";
    else if (view == TallyView::etendue)
      lines += tally.name + ": " + etendue_text(tally) + "\n";
    else if (view == TallyView::ledger)
      lines += ledger_lines(tally, point.emitted);
    else if (both(tally, is_position))
      lines += tally.name + ": " + light_spread_text(tally) + "\n";
  }
  return lines;
}

}  // namespace scintray::report
