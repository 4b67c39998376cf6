#include "scintray/report/plots/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr double kTextHeight = 14.0;
/// Mean character width of the widest sans-serif font of browsers (DejaVu) at 14 units; names are bold.
constexpr double kLetterWidth = 8.4, kBoldLetterWidth = 9.6;
constexpr int kColours = 7;
constexpr double kLegendRow = 22.0;
constexpr double kMarker = 4.5;
constexpr double kTopAxisHeight = 46.0;
/// Width from which on a plot scrolls sideways on a phone, so that its text can be read.
constexpr double kWide = 600.0;

double text_width(const std::string& words, double letter) {
  return letter * static_cast<double>(display_width(words));
}

std::string number(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

std::string line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" +
         number(y2) + "\" class=\"" + kind + "\"/>\n";
}

std::string text(double x, double y, const std::string& kind, const std::string& words) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" class=\"" + kind + "\">" +
         escape_html(words) + "</text>\n";
}

/// Ticks are exact multiples, so six digits represent them; a rounding residue of zero is written as zero.
std::string tick_text(double tick) { return compact(std::abs(tick) < 1e-14 ? 0.0 : tick, 6); }

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// An axis: maps data to the drawing and computes the ticks.
struct Axis {
  std::vector<double> ticks;
  double low = 0.0, high = 1.0;   ///< in data, or log10 of data
  double start = 0.0, end = 1.0;  ///< in drawing units
  bool log = false;

  double at(double value) const {
    const double v = log ? std::log10(value) : value;
    return start + (v - low) / (high - low) * (end - start);
  }
};

Axis linear_axis(Range range, int count, bool tight) {
  if (range.high == range.low) {
    const double half = range.low == 0.0 ? 1.0 : 0.1 * std::abs(range.low);
    range = {range.low - half, range.high + half};
  }
  Axis axis;
  axis.ticks = nice_ticks(range.low, range.high, count);
  if (tight) {
    const double margin = 0.03 * (range.high - range.low);
    axis.low = range.low - margin;
    axis.high = range.high + margin;
    std::erase_if(axis.ticks, [&](double tick) { return tick < axis.low || tick > axis.high; });
  } else {
    axis.low = axis.ticks.front();
    axis.high = axis.ticks.back();
  }
  return axis;
}

Axis log_axis(const Range& range) {
  Axis axis;
  axis.log = true;
  axis.low = std::floor(std::log10(range.low));
  axis.high = std::max(axis.low + 1.0, std::ceil(std::log10(range.high)));
  const int step = std::max(1, static_cast<int>((axis.high - axis.low) / 6.0));
  for (double power = axis.low; power <= axis.high; power += step)
    axis.ticks.push_back(std::pow(10.0, power));
  return axis;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    check();
    direct_labels_ =
        !plot.legend_above && plot.series.size() <= kColours && plot.series.size() > 1 &&
        std::none_of(plot.series.begin(), plot.series.end(), [](const auto& s) { return s.steps; });
    set_axes();
  }

  std::string svg() const {
    std::string out = "<svg class=\"plot\"" + std::string(plot_.width > kWide ? " data-wide=\"\"" : "") +
                      " viewBox=\"0 0 " + number(plot_.width) + " " + number(plot_.height) +
                      "\" role=\"img\" aria-label=\"" + escape_html(plot_.title) + "\">\n<title>" +
                      escape_html(plot_.title) + "</title>\n";
    out += "<g class=\"axes\">\n" + axes() + "</g>\n<g class=\"curves\">\n";
    for (std::size_t i = 0; i < plot_.series.size(); ++i) out += series(i);
    out += "</g>\n" + (direct_labels_ ? labels_at_ends() : legend());
    return out + "</svg>\n";
  }

  PlotFrame frame() const { return {left_, top_, right_, bottom_, x_.low, x_.high, y_.low, y_.high}; }

 private:
  void check() const {
    for (const PlotSeries& series : plot_.series) {
      const std::size_t expected = series.y.size() + (series.steps ? 1 : 0);
      if (series.x.size() != expected || (!series.error.empty() && series.error.size() != series.y.size()))
        throw std::invalid_argument("svg_plot: lengths of a series differ");
    }
  }

  bool drawable(double y) const { return std::isfinite(y) && (!plot_.log_y || y > 0.0); }

  void set_axes() {
    Range x, y;
    bool steps = false;
    for (const PlotSeries& series : plot_.series) {
      steps = steps || series.steps;
      for (const double value : series.x) x.include(value);
      for (std::size_t i = 0; i < series.y.size(); ++i) {
        if (!drawable(series.y[i])) continue;
        const double error = series.error.empty() ? 0.0 : series.error[i];
        y.include(series.y[i] + error);
        if (!plot_.log_y)  // the error bar of a non-negative quantity does not extend below zero
          y.include(plot_.y_from_zero && series.y[i] >= 0.0 ? std::max(0.0, series.y[i] - error)
                                                            : series.y[i] - error);
        else
          y.include(series.y[i]);
      }
    }
    if (!(x.low <= x.high) || !(y.low <= y.high)) throw std::invalid_argument("svg_plot: nothing to draw");
    if (plot_.y_from_zero && !plot_.log_y) y.include(0.0);
    if (plot_.y_high && !plot_.log_y) y.include(*plot_.y_high);
    x_ = linear_axis(x, 8, !steps);
    if (steps) {
      x_.low = x.low;
      x_.high = x.high;
      std::erase_if(x_.ticks, [&](double tick) { return tick < x.low || tick > x.high; });
    }
    if (plot_.x_low && plot_.x_high) fix_x(*plot_.x_low, *plot_.x_high);
    y_ = plot_.log_y ? log_axis(y) : linear_axis(y, 5, false);
    double widest = 0.0, longest = 0.0;
    for (const double tick : y_.ticks) widest = std::max(widest, text_width(tick_text(tick), kLetterWidth));
    if (direct_labels_)
      for (const PlotSeries& series : plot_.series)
        longest = std::max(longest, text_width(series.label, kBoldLetterWidth));
    left_ = widest + 46.0;
    right_ = plot_.width - std::max(16.0, longest + 22.0);
    top_ = direct_labels_ || plot_.series.size() < 2 ? 14.0 : legend_places().back().y + 22.0;
    if (plot_.top) top_ += kTopAxisHeight;
    bottom_ = plot_.height - 54.0;
    x_.start = left_;
    x_.end = right_;
    y_.start = bottom_;
    y_.end = top_;
  }

  void fix_x(double low, double high) {
    x_.low = low;
    x_.high = high;
    x_.ticks = nice_ticks(low, high, 8);
    if (plot_.x_step > 0.0) {
      x_.ticks.clear();
      for (double k = std::ceil(low / plot_.x_step); k * plot_.x_step <= high; k += 1.0)
        x_.ticks.push_back(k * plot_.x_step);
    }
    std::erase_if(x_.ticks, [&](double tick) { return tick < low || tick > high; });
  }

  std::string axes() const {
    std::string out;
    for (const double tick : y_.ticks) {
      out += line(left_, y_.at(tick), right_, y_.at(tick), "grid");
      out += text(left_ - 8.0, y_.at(tick) + 5.0, "tick end", tick_text(tick));
    }
    for (const double tick : x_.ticks) {
      out += line(x_.at(tick), bottom_, x_.at(tick), bottom_ + 5.0, "axis");
      out += text(x_.at(tick), bottom_ + 21.0, "tick middle", tick_text(tick));
    }
    out += line(left_, bottom_, right_, bottom_, "axis");
    out += text(0.5 * (left_ + right_), plot_.height - 10.0, "label middle", plot_.x_label);
    const double middle = 0.5 * (top_ + bottom_);
    out += "<text transform=\"translate(18 " + number(middle) + ") rotate(-90)\" class=\"label middle\">" +
           escape_html(plot_.y_label) + "</text>\n";
    return out + top_axis();
  }

  std::string top_axis() const {
    if (!plot_.top) return "";
    std::string out = line(left_, top_, right_, top_, "axis");
    const double low = x_.low / plot_.top->per_unit, high = x_.high / plot_.top->per_unit;
    for (const double tick : nice_ticks(low, high, 8)) {
      if (tick < low || tick > high) continue;
      const double x = x_.at(tick * plot_.top->per_unit);
      out += line(x, top_, x, top_ - 5.0, "axis");
      out += text(x, top_ - 10.0, "tick middle", tick_text(tick));
    }
    return out + text(0.5 * (left_ + right_), top_ - 28.0, "label middle", plot_.top->label);
  }

  std::string series(std::size_t index) const {
    const PlotSeries& s = plot_.series[index];
    std::string path, marks;
    bool joined = false;
    for (std::size_t i = 0; i < s.y.size(); ++i) {
      if (!drawable(s.y[i])) {
        joined = false;
        continue;
      }
      const double y = y_.at(s.y[i]);
      const std::string go = joined ? " L" : " M";
      if (s.steps) {
        path +=
            go + number(x_.at(s.x[i])) + " " + number(y) + " L" + number(x_.at(s.x[i + 1])) + " " + number(y);
      } else {
        path += go + number(x_.at(s.x[i])) + " " + number(y);
        if (s.marks) marks += marker(index, x_.at(s.x[i]), y);
      }
      joined = true;
      if (!s.error.empty() && s.error[i] > 0.0)
        marks += error_bar(s.steps ? 0.5 * (x_.at(s.x[i]) + x_.at(s.x[i + 1])) : x_.at(s.x[i]), s.y[i],
                           s.error[i], !s.steps);
    }
    std::string out = "<g class=\"series c" + std::to_string(index % kColours) + "\">\n";
    if (s.steps || s.joined)
      out += std::string("<path class=\"curve") + (s.dashed ? " dashed" : "") + "\" d=\"" + path + "\"/>\n";
    return out + marks + "</g>\n";
  }

  std::string error_bar(double x, double value, double error, bool caps) const {
    const double high = y_.at(value + error);
    const double low =
        plot_.log_y && value - error <= 0.0 ? y_.start : std::min(y_.start, y_.at(value - error));
    std::string out = line(x, low, x, high, "error");
    if (caps) out += line(x - 3.5, low, x + 3.5, low, "error") + line(x - 3.5, high, x + 3.5, high, "error");
    return out;
  }

  /// Shapes differ as well as colours.
  static std::string marker(std::size_t index, double x, double y) {
    const auto point = [&](double dx, double dy) { return number(x + dx) + "," + number(y + dy) + " "; };
    const double r = kMarker;
    std::string points;
    switch (index % 4) {
      case 0:
        return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"" + number(r) +
               "\" class=\"mark\"/>\n";
      case 1:
        points = point(-r, -r) + point(r, -r) + point(r, r) + point(-r, r);
        break;
      case 2:
        points = point(0, -1.3 * r) + point(1.2 * r, r) + point(-1.2 * r, r);
        break;
      default:
        points = point(0, -1.4 * r) + point(1.4 * r, 0) + point(0, 1.4 * r) + point(-1.4 * r, 0);
    }
    return "<polygon points=\"" + points + "\" class=\"mark\"/>\n";
  }

  /// Each label beside the end of its curve, moved apart where they would touch.
  std::string labels_at_ends() const {
    struct Label {
      std::size_t series;
      double y;
    };
    std::vector<Label> labels;
    for (std::size_t i = 0; i < plot_.series.size(); ++i) {
      const PlotSeries& s = plot_.series[i];
      if (s.y.empty()) continue;
      const auto last = static_cast<std::size_t>(std::max_element(s.x.begin(), s.x.end()) - s.x.begin());
      labels.push_back({i, drawable(s.y[last]) ? y_.at(s.y[last]) : bottom_});
    }
    std::sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
    constexpr double kApart = kTextHeight + 4.0;
    for (std::size_t i = 1; i < labels.size(); ++i)
      labels[i].y = std::max(labels[i].y, labels[i - 1].y + kApart);
    double limit = bottom_;
    for (std::size_t i = labels.size(); i-- > 0; limit -= kApart) labels[i].y = std::min(labels[i].y, limit);
    std::string out;
    for (const Label& label : labels)
      out += text(right_ + 10.0, label.y + 5.0, "name c" + std::to_string(label.series % kColours),
                  plot_.series[label.series].label);
    return out;
  }

  struct LegendPlace {
    double x, y;
  };

  /// Names above the plot, in as many rows as required.
  std::vector<LegendPlace> legend_places() const {
    std::vector<LegendPlace> places;
    LegendPlace next{left_, 18.0};
    for (const PlotSeries& series : plot_.series) {
      const double width = 28.0 + text_width(series.label, kBoldLetterWidth);
      if (next.x > left_ && next.x + width > plot_.width) next = {left_, next.y + kLegendRow};
      places.push_back(next);
      next.x += width + 24.0;
    }
    return places;
  }

  std::string legend() const {
    if (plot_.series.size() < 2) return "";
    std::string out;
    const auto places = legend_places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto [x, y] = places[i];
      const std::string colour = "c" + std::to_string(i % kColours);
      const PlotSeries& s = plot_.series[i];
      out += "<g class=\"series " + colour + "\">";
      if (s.steps || s.joined) out += line(x, y, x + 22.0, y, s.dashed ? "curve dashed" : "curve");
      if (!s.steps && s.marks) out += marker(i, x + 11.0, y);
      out += "</g>\n";
      out += text(x + 28.0, y + 5.0, "name " + colour, plot_.series[i].label);
    }
    return out;
  }

  const Plot& plot_;
  Axis x_, y_;
  double left_ = 0.0, right_ = 0.0, top_ = 0.0, bottom_ = 0.0;
  bool direct_labels_ = false;
};

}  // namespace

std::vector<double> nice_ticks(double low, double high, int count) {
  const double raw = (high - low) / std::max(1, count);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double multiple : {5.0, 2.0, 1.0})
    if (multiple * power >= raw * 0.999) step = multiple * power;
  const auto first = static_cast<long>(std::floor(low / step + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / step - 1e-9));
  std::vector<double> ticks;
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

std::string svg_plot(const Plot& plot) { return Drawing(plot).svg(); }

PlotFrame plot_frame(const Plot& plot) { return Drawing(plot).frame(); }

}  // namespace scintray::report
