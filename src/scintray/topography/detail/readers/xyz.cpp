#include "scintray/topography/detail/readers/xyz.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"

namespace scintray::topography {

namespace {

constexpr double kTolerance = 0.01;

/// Equally spaced positions along one axis.
struct GridAxis {
  double first = 0.0, step = 0.0;
  double count = 0.0;  ///< whole; beyond kMostPoints when the points lie on no grid

  /// Index of the position next to `value`.
  std::size_t index(double value) const {
    return static_cast<std::size_t>(std::lround((value - first) / step));
  }
  bool holds(double value) const {
    const double at = (value - first) / step;
    return std::abs(at - std::round(at)) <= kTolerance;
  }
};

/// The step is the mean over the gaps that are not rounding.
GridAxis axis_of(std::vector<double> positions) {
  std::sort(positions.begin(), positions.end());
  GridAxis axis{positions.front(), 0.0, 1.0};
  const double range = positions.back() - positions.front();
  // A point's digits may differ from row to row, but by far less than a grid's step.
  const double rounding = 1e-6 * range;
  double smallest = range;
  for (std::size_t k = 1; k < positions.size(); ++k)
    if (const double gap = positions[k] - positions[k - 1]; gap > rounding)
      smallest = std::min(smallest, gap);
  if (!(smallest > 0.0) || !std::isfinite(range)) return axis;
  axis.count = std::round(range / smallest) + 1.0;
  axis.step = range / (axis.count - 1.0);
  return axis;
}

}  // namespace

bool is_xyz_list(const RawMap& matrix) { return matrix.columns == 3 && matrix.rows >= 4; }

RawMap grid_of_xyz(const std::vector<double>& values, const std::string& file) {
  const std::size_t points = values.size() / 3;
  std::vector<double> xs, ys;
  for (std::size_t k = 0; k < points; ++k) {
    xs.push_back(values[3 * k]);
    ys.push_back(values[3 * k + 1]);
  }
  const auto finite = [](double v) { return std::isfinite(v); };
  const bool sound = std::all_of(xs.begin(), xs.end(), finite) && std::all_of(ys.begin(), ys.end(), finite);
  const GridAxis x = sound ? axis_of(xs) : GridAxis(), y = sound ? axis_of(ys) : GridAxis();
  const auto refuse = [&](const std::string& what) {
    throw core::InputError(
        {{file},
         "three numbers a line, taken as x y z, " + what + "; expected points of a regular grid",
         "put them on a grid in Gwyddion (Rasterize) and save that as .gsf"});
  };
  if (!(x.step > 0.0) || !(y.step > 0.0) || !std::isfinite(y.step / x.step)) refuse("do not span a plane");
  if (x.count * y.count > 2.0 * static_cast<double>(points)) refuse("fill less than half of their grid");
  RawMap map;
  map.format = "x y z list";
  map.columns = static_cast<std::uint32_t>(x.count);
  map.rows = static_cast<std::uint32_t>(y.count);
  map.pitch_ratio = y.step / x.step;
  map.values.assign(std::size_t{map.columns} * map.rows, std::nan(""));
  std::vector<bool> taken(map.values.size(), false);
  for (std::size_t k = 0; k < points; ++k) {
    if (!x.holds(xs[k]) || !y.holds(ys[k])) refuse("do not lie at equal distances");
    // y points up, and the first row is the top one.
    const std::size_t at = (map.rows - 1 - y.index(ys[k])) * map.columns + x.index(xs[k]);
    if (taken[at]) refuse("give a point twice (number " + std::to_string(k + 1) + ")");
    taken[at] = true;
    map.values[at] = values[3 * k + 2];
  }
  return map;
}

}  // namespace scintray::topography
