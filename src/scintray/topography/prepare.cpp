#include "scintray/topography/prepare.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/missing_points.hpp"

namespace scintray::topography {

namespace {

void require(bool good, const std::string& what, const std::string& expected) {
  if (!good) throw core::InputError({{}, what + "; expected " + expected, ""});
}

/// Index on one axis, wrapped around when the map is periodic; empty beyond an edge.
std::optional<std::uint32_t> neighbour(std::uint32_t at, long offset, std::uint32_t n, bool periodic) {
  const long index = static_cast<long>(at) + offset;
  if (index >= 0 && index < static_cast<long>(n)) return static_cast<std::uint32_t>(index);
  if (!periodic) return std::nullopt;
  const long size = static_cast<long>(n);
  return static_cast<std::uint32_t>(((index % size) + size) % size);
}

/// Weighted mean of neighbours on one axis, for every pixel; missing points have no weight.
void blur_axis(HeightMap& map, bool along_x, double sigma_in_pixels) {
  const long reach = static_cast<long>(std::ceil(6.0 * sigma_in_pixels));
  std::vector<double> weights;
  for (long k = 0; k <= reach; ++k)
    weights.push_back(std::exp(-0.5 * static_cast<double>(k * k) / (sigma_in_pixels * sigma_in_pixels)));
  const std::vector<double> before = map.heights_um;
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i) {
      double sum = 0.0, total = 0.0;
      for (long k = -reach; k <= reach; ++k) {
        const auto other =
            along_x ? neighbour(i, k, map.columns, map.periodic) : neighbour(j, k, map.rows, map.periodic);
        if (!other) continue;
        const double height = along_x ? before[std::size_t{j} * map.columns + *other]
                                      : before[std::size_t{*other} * map.columns + i];
        if (std::isnan(height)) continue;
        const double weight = weights[static_cast<std::size_t>(std::abs(k))];
        sum += weight * height;
        total += weight;
      }
      if (!std::isnan(map.at(i, j))) map.at(i, j) = sum / total;
    }
}

/// Powers x^a y^b with a + b <= degree.
Eigen::VectorXd monomials(double x, double y, int degree) {
  Eigen::VectorXd result((degree + 1) * (degree + 2) / 2);
  Eigen::Index k = 0;
  for (int order = 0; order <= degree; ++order)
    for (int b = 0; b <= order; ++b) result[k++] = std::pow(x, order - b) * std::pow(y, b);
  return result;
}

/// Local linear regression at one point of a line that has a height. Where fewer than two points of
/// the window have one, the slope is undefined and the point is unchanged.
double loess_at(const double* line, std::uint32_t columns, std::uint32_t at, double half_width) {
  const long reach = static_cast<long>(std::ceil(half_width)) - 1;
  double s0 = 0, s1 = 0, s2 = 0, z0 = 0, z1 = 0;
  for (long k = -reach; k <= reach; ++k) {
    const auto other = neighbour(at, k, columns, false);
    if (!other || std::isnan(line[*other])) continue;
    const double x = static_cast<double>(k), u = std::abs(x) / half_width;
    const double weight = std::pow(1.0 - u * u * u, 3);
    s0 += weight;
    s1 += weight * x;
    s2 += weight * x * x;
    z0 += weight * line[*other];
    z1 += weight * x * line[*other];
  }
  const double determinant = s0 * s2 - s1 * s1;
  return determinant > 1e-12 * s0 * s0 ? (s2 * z0 - s1 * z1) / determinant : line[at];
}

}  // namespace

void subtract_mean(HeightMap& map) {
  double sum = 0.0;
  for (const double h : map.heights_um)
    if (!std::isnan(h)) sum += h;
  const std::uint64_t known = map.heights_um.size() - count_missing(map);
  require(known > 0, "height map in which every point is missing", "at least one height");
  for (double& h : map.heights_um) h -= sum / static_cast<double>(known);
  map.steps.push_back("mean height subtracted");
}

void level_polynomial(HeightMap& map, int degree) {
  require(degree >= 0 && degree <= 8, fmt::format("levelling by degree {}", degree), "0 to 8");
  const Eigen::Index terms = (degree + 1) * (degree + 2) / 2;
  const std::uint64_t known = map.heights_um.size() - count_missing(map);
  require(known > 0, "height map in which every point is missing", "at least one height");
  require(known >= static_cast<std::uint64_t>(terms) && map.columns > static_cast<std::uint32_t>(degree) &&
              map.rows > static_cast<std::uint32_t>(degree),
          fmt::format("map of {} x {} points, {} of them with a height, too small for degree {}", map.columns,
                      map.rows, known, degree),
          "more points than the degree on both axes");
  // Coordinates in [-1, 1] keep the normal equations well conditioned at these degrees.
  const auto unit = [](std::uint32_t k, std::uint32_t n) { return n > 1 ? 2.0 * k / (n - 1.0) - 1.0 : 0.0; };
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i) {
      if (std::isnan(map.at(i, j))) continue;
      const Eigen::VectorXd m = monomials(unit(i, map.columns), unit(j, map.rows), degree);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(m);
      right += map.at(i, j) * m;
    }
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal.selfadjointView<Eigen::Lower>());
  require(solver.info() == Eigen::Success && solver.rcond() > 1e-13,
          fmt::format("points with a height do not determine a polynomial of degree {}", degree),
          "points spread over the map, or a lower degree");
  const Eigen::VectorXd coefficients = solver.solve(right);
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i)
      map.at(i, j) -= coefficients.dot(monomials(unit(i, map.columns), unit(j, map.rows), degree));
  map.steps.push_back(degree == 1 ? "plane subtracted"
                                  : fmt::format("polynomial of degree {} subtracted", degree));
}

void crop(HeightMap& map, const CropBox& box) {
  const auto inside = [](std::uint32_t first, std::uint32_t count, std::uint32_t n) {
    return count >= 2 && first <= n && count <= n - first;
  };
  if (!inside(box.column, box.columns, map.columns) || !inside(box.row, box.rows, map.rows))
    throw core::InputError(
        {{},
         fmt::format(
             "crop of {} x {} points from column {}, row {} (counted from 0); expected at least 2 x 2 "
             "points inside the map of {} x {}",
             box.columns, box.rows, box.column, box.row, map.columns, map.rows),
         ""});
  if (box.columns == map.columns && box.rows == map.rows) return;
  std::vector<double> heights;
  heights.reserve(std::size_t{box.columns} * box.rows);
  for (std::uint32_t j = 0; j < box.rows; ++j)
    for (std::uint32_t i = 0; i < box.columns; ++i) heights.push_back(map.at(box.column + i, box.row + j));
  map.heights_um = std::move(heights);
  map.columns = box.columns;
  map.rows = box.rows;
  map.periodic = false;
  map.steps.push_back(fmt::format("cropped to {} x {} points from column {}, row {}", box.columns, box.rows,
                                  box.column, box.row));
}

CropBox crop_box_um(const HeightMap& map, double x_um, double y_um, double width_um, double height_um) {
  const auto points = [](double length_um, double pitch_um, const std::string& name) {
    const double n = std::round(length_um / pitch_um);
    require(n >= 0.0 && n <= 1e9, fmt::format("crop with {} of {} um", name, length_um), "0 or more");
    return static_cast<std::uint32_t>(n);
  };
  return {points(x_um, map.pitch_x_um, "x"), points(y_um, map.pitch_y_um, "y"),
          points(width_um, map.pitch_x_um, "a width"), points(height_um, map.pitch_y_um, "a height")};
}

void filter_gaussian(HeightMap& map, double sigma_um) {
  const double narrow = std::min(map.columns * map.pitch_x_um, map.rows * map.pitch_y_um);
  require(sigma_um > 0.0 && sigma_um <= 0.5 * narrow, fmt::format("Gaussian filter of {:.6g} um", sigma_um),
          "above 0, up to half the map");
  blur_axis(map, true, sigma_um / map.pitch_x_um);
  blur_axis(map, false, sigma_um / map.pitch_y_um);
  map.steps.push_back(fmt::format("Gaussian filter, standard deviation {:.6g} um", sigma_um));
}

void filter_median(HeightMap& map, int radius) {
  require(radius >= 1 && radius <= 50, "median filter of radius " + std::to_string(radius), "1 to 50 pixels");
  const HeightMap before = map;
  std::vector<double> around;
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i) {
      if (std::isnan(before.at(i, j))) continue;
      around.clear();
      for (long b = -radius; b <= radius; ++b)
        for (long a = -radius; a <= radius; ++a) {
          const auto x = neighbour(i, a, map.columns, map.periodic),
                     y = neighbour(j, b, map.rows, map.periodic);
          if (x && y && !std::isnan(before.at(*x, *y))) around.push_back(before.at(*x, *y));
        }
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::nth_element(around.begin(), middle, around.end());
      map.at(i, j) = *middle;
    }
  map.steps.push_back("median filter, radius " + std::to_string(radius) + " pixels");
}

void filter_loess_lines(HeightMap& map, double width_um) {
  const double half_width = 0.5 * width_um / map.pitch_x_um;
  require(half_width > 1.0 && 2.0 * half_width <= map.columns,
          fmt::format("LOESS width of {:.6g} um", width_um),
          fmt::format("more than two pitches, {:.6g} um, so that the window holds three points, and not more "
                      "than a line, {:.6g} um",
                      2.0 * map.pitch_x_um, map.columns * map.pitch_x_um));
  std::vector<double> line(map.columns);
  for (std::uint32_t j = 0; j < map.rows; ++j) {
    std::copy_n(&map.at(0, j), map.columns, line.begin());
    // At an end of the line half the window is missing; a window of two points is the minimum.
    for (std::uint32_t i = 0; i < map.columns; ++i)
      if (!std::isnan(line[i])) map.at(i, j) = loess_at(line.data(), map.columns, i, half_width);
  }
  map.steps.push_back(fmt::format("LOESS along lines, width {:.6g} um", width_um));
}

}  // namespace scintray::topography
