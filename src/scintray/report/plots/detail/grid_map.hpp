#pragma once
/// Plots of a quantity over two axes.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scintray::report {

/// A grid of values with its axes.
struct GridMap {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;  ///< rows x columns, the first row lowest
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  std::string x_label, y_label, value_label;
  std::string alternative;  ///< read by screen readers
  /// Colours are linear in log(1 + value / unit) instead of in the value.
  bool logarithmic = false;
  double unit = 1.0;                            ///< of the logarithmic scale, above 0
  std::vector<std::array<double, 4>> lines;     ///< drawn over the cells: x and y of both ends
  std::vector<std::array<double, 4>> outlines;  ///< rectangles over the cells: least x and y, largest x and y
  struct Mark {
    double x = 0.0, y = 0.0;
    std::string text;
  };
  std::vector<Mark> marks;                    ///< texts centred at places of the map
  std::vector<std::string> x_names, y_names;  ///< of the columns and rows, where they have names
};

/// Colours (viridis) from 0 to the largest value, axes with ticks, lines, marks, and the scale below. Cells
/// keep the proportions of the axes when these are within a factor of 4, so that a face keeps its shape.
/// Throws std::invalid_argument when the values do not fill the grid.
std::string grid_map(const GridMap& map);

/// Plot of directions over a hemisphere, projected along the normal: distance from the centre is the polar
/// angle (circles at 30, 60 and 90 deg), azimuth 0 to the right and rising counter-clockwise.
/// @param values  rows of equal steps in the squared sine of the polar angle, columns of azimuth from
///                -180 to 180 deg
std::string polar_map(const GridMap& map);

/// Cells of a hemisphere and its picture, for the script of pages.
struct PolarCells {
  std::vector<double> edges_deg;      ///< polar angles between the rings of cells, from 0
  std::vector<double> count;          ///< cells of each ring, of equal azimuth
  std::optional<double> start_deg;    ///< azimuth at which first cells begin; else their middles are at 0
  double middle = 0.0, radius = 0.0;  ///< of the circle at 90 deg, in units of the drawing
  std::uint32_t pixels = 0;           ///< of its picture, a side
};

/// The cells as members of a JSON object, after a comma.
std::string polar_json(const PolarCells& cells);

/// CSS of both pictures.
std::string grid_map_style();

}  // namespace scintray::report
