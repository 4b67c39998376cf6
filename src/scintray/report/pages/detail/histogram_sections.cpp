#include <algorithm>
#include <numeric>

#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/detail/sections.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

/// Number of points whose histograms are shown first where there is no sweep.
constexpr std::size_t kFirstPoints = 4;

std::uint64_t sum_of(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::vector<double> even_edges(std::size_t bins, double width) {
  std::vector<double> edges;
  for (std::size_t i = 0; i <= bins; ++i) edges.push_back(width * static_cast<double>(i));
  return edges;
}

std::vector<double> as_doubles(const std::vector<std::uint64_t>& counts) {
  return {counts.begin(), counts.end()};
}

/// Points whose histograms are shown first: the ends of each curve of a sweep, else the first few.
std::vector<std::size_t> shown_points(const tally::RunResult& run) {
  std::vector<std::size_t> shown;
  if (const auto view = view_sweep(run)) {
    for (const SweepSeries& series : view->series) {
      shown.push_back(series.points.front());
      if (series.points.size() > 1) shown.push_back(series.points.back());
    }
  } else {
    for (std::size_t i = 0; i < std::min(run.points.size(), kFirstPoints); ++i) shown.push_back(i);
  }
  return shown;
}

/// "31.2 ± 0.1° inside and 40.1 ± 0.2° outside".
std::string half_angles(const analysis::CrossingAngles& tally) {
  const auto text = [](const std::vector<std::uint64_t>& counts, const std::vector<double>& groups) {
    const core::Estimate half = analysis::divergence(counts, groups).half_rad;
    return with_error({half.value / core::kDegree, half.error / core::kDegree}) + "°";
  };
  return text(tally.inside, tally.inside_groups) + " inside and " +
         text(tally.outside, tally.outside_groups) + " outside";
}

std::string angle_figures(const tally::PointResult& point) {
  std::string figures;
  for (const analysis::CrossingAngles& tally : analysis::crossing_angles(point)) {
    if (sum_of(tally.inside) + sum_of(tally.outside) == 0) continue;
    Plot plot;
    plot.title = point_label(point) + ": " + tally.name;
    plot.x_label = "angle to the outward normal of " + tally.face + " (deg)";
    plot.y_label = "crossings per bin";
    plot.width = 560.0;
    plot.height = 300.0;
    const auto add = [&](const char* side, const std::vector<std::uint64_t>& counts) {
      if (counts.empty()) return;
      const double width = 90.0 / static_cast<double>(counts.size());
      plot.series.push_back({side, even_edges(counts.size(), width), as_doubles(counts), {}, true});
    };
    add("inside", tally.inside);
    add("outside", tally.outside);
    figures += "<figure>" + chart(plot) + "<figcaption>" + escape_html(plot.title) +
               (tally.detected_only ? " (last crossing of each detected photon)" : " (every crossing)") +
               ". Half of the light is within " + half_angles(tally) +
               " of the normal.</figcaption></figure>\n";
  }
  return figures;
}

}  // namespace

std::string angle_section(const tally::RunResult& run) {
  const auto shown = shown_points(run);
  std::string first, others;
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    const bool drawn_at_once = std::find(shown.begin(), shown.end(), i) != shown.end();
    (drawn_at_once ? first : others) += angle_figures(run.points[i]);
  }
  if (first.empty() && others.empty()) return "";
  std::string body = "<div class=\"grid\">\n" + first + "</div>\n";
  if (!others.empty())
    body += "<details><summary>The points between</summary>\n<div class=\"grid\">\n" + others +
            "</div></details>\n";
  return section("Exit angles", body);
}

std::string path_section(const tally::RunResult& run) {
  std::string figures, rows;
  for (const tally::PointResult& point : run.points) {
    if (point.detected_path_mm.count > 0)
      rows += "<tr>" + cell(point_label(point), "th") +
              number_cell(with_error(point.detected_path_mm.mean()) + " mm") +
              number_cell(with_error(point.detected_time_ns.mean()) + " ns") +
              number_cell(with_error(point.detected_interactions.mean())) +
              number_cell(with_error(point.interactions.mean())) + "</tr>\n";
  }
  std::size_t used = 0;
  for (const tally::PointResult& point : run.points)
    for (std::size_t bin = 0; bin < 50; ++bin)
      if (point.detected_path_histogram[bin] > 0) used = std::max(used, bin + 1);
  const std::size_t bins = std::min<std::size_t>(50, used + 1);
  const auto shown = shown_points(run);
  for (std::size_t k = 0; k < shown.size() && used > 0; k += 2) {
    Plot plot;
    plot.title = "Path length of detected photons";
    plot.x_label = "path length (mm)";
    plot.y_label = "photons per 10 mm";
    plot.width = 560.0;
    plot.height = 300.0;
    std::uint64_t beyond = 0;
    for (std::size_t j = k; j < std::min(k + 2, shown.size()); ++j) {
      const tally::PointResult& point = run.points[shown[j]];
      const auto& histogram = point.detected_path_histogram;
      plot.series.push_back({point_label(point),
                             even_edges(bins, 10.0),
                             {histogram.begin(), histogram.begin() + static_cast<long>(bins)},
                             {},
                             true});
      beyond += histogram.back();
    }
    figures += "<figure>" + chart(plot) + "<figcaption>Path length of detected photons" +
               (plot.series.size() == 1 ? ": " + escape_html(plot.series[0].label) : "") + "; " +
               grouped(beyond) + " travelled 500 mm or more</figcaption></figure>\n";
  }
  if (rows.empty()) return "";
  return section(
      "Paths of detected photons",
      "<div class=\"grid\">\n" + figures + "</div>\n" +
          table({"point", "mean path", "mean time", "bounces, detected", "bounces, all photons"}, rows));
}

}  // namespace scintray::report
