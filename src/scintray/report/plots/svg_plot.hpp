#pragma once
/// Plots as SVG, for a page whose style sheet is `svg_plot_style()`.

#include <optional>
#include <string>
#include <vector>

namespace scintray::report {

struct PlotSeries {
  std::string label;
  std::vector<double> x;  ///< points: positions; steps: edges, one more than y
  std::vector<double> y;
  std::vector<double> error;  ///< one sigma; empty for none
  bool steps = false;         ///< a histogram's outline instead of points joined by lines
  bool marks = true;          ///< points: a mark at each; without, for many points, the line alone
  bool joined = true;         ///< points: by lines
  bool dashed = false;        ///< lines: for computed, not measured, curves
};

/// A second scale along the top of a plot, proportional to that along the bottom.
struct TopAxis {
  std::string label;
  double per_unit = 1.0;  ///< units of the bottom axis for one of the top; above 0
};

struct Plot {
  std::string title;  ///< read by screen readers; not drawn
  std::string x_label, y_label;
  std::vector<PlotSeries> series;
  std::optional<TopAxis> top;
  bool log_y = false;                    ///< values of zero and below are left out
  bool y_from_zero = true;               ///< linear axis only
  std::optional<double> x_low, x_high;   ///< range of the axis, both or none; else that of the data
  double x_step = 0.0;                   ///< between ticks, for axes with x_low and x_high; 0: chosen
  std::optional<double> y_high;          ///< linear axis: its upper end at least
  bool legend_above = false;             ///< names in rows above the plot, not at the ends of the curves
  double width = 860.0, height = 380.0;  ///< user units; the plot scales to the page
};

/// The plot as an SVG element; text is escaped. Throws std::invalid_argument when the lengths of a series
/// differ or nothing is finite.
std::string svg_plot(const Plot& plot);

/// Area of a plot in user units, y downwards, and the data at its borders.
struct PlotFrame {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  double x_low = 0.0, x_high = 0.0;
  double y_low = 0.0, y_high = 0.0;  ///< log10 of the data when the axis is logarithmic
};

/// The frame of the plot of svg_plot(). Throws std::invalid_argument as that does.
PlotFrame plot_frame(const Plot& plot);

/// The plot with its numbers for the script of pages, which adds values under the pointer, zoom, a
/// logarithmic axis and files to save. Without the script only the drawing is shown.
std::string chart(const Plot& plot);

/// A drawing in an area that scrolls on narrow screens, with `json` for the script of pages.
/// @param kind  of the data: "plot", "grid", "polar"; @param name  for screen readers
std::string chart_box(const std::string& kind, const std::string& name, const std::string& drawing,
                      const std::string& json);

/// Numbers as a JSON array, to `digits` significant digits; values that are not finite are null.
std::string json_numbers(const std::vector<double>& numbers, int digits = 7);

/// A text as a JSON string.
std::string json_text(const std::string& text);

/// The plot as a separate SVG file, with its style and a background, light or dark as the viewer's.
std::string svg_file(const Plot& plot);

/// Ticks at multiples of 1, 2 or 5 times a power of ten that cover [low, high], about `count` of them.
std::vector<double> nice_ticks(double low, double high, int count);

/// CSS of plots: light and dark colours (Okabe and Ito 2008, distinguishable by the colour-blind).
std::string svg_plot_style();

}  // namespace scintray::report
