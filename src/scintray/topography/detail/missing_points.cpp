#include "scintray/topography/detail/missing_points.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/topography/prepare.hpp"

namespace scintray::topography {

namespace {

constexpr std::uint64_t kMostToFill = 4'000'000;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Robust standard deviation of deviations from zero.
double robust_deviation(std::vector<double> absolute) {
  const double middle = median(absolute);
  if (middle > 0.0) return 1.4826 * middle;
  double sum = 0.0;
  for (const double value : absolute) sum += value;
  return 1.2533 * sum / static_cast<double>(absolute.size());
}

struct Neighbour {
  std::size_t point;
  double weight;  ///< 1 / pitch^2
};

/// The up to four neighbours of a point.
class Grid {
 public:
  explicit Grid(const HeightMap& map) : map_(map) {}

  template <class Visit>
  void neighbours(std::size_t point, const Visit& visit) const {
    const auto i = static_cast<std::uint32_t>(point % map_.columns),
               j = static_cast<std::uint32_t>(point / map_.columns);
    const double x = 1.0 / (map_.pitch_x_um * map_.pitch_x_um), y = 1.0 / (map_.pitch_y_um * map_.pitch_y_um);
    const auto on_x = [&](std::uint32_t column) { visit(Neighbour{point - i + column, x}); };
    const auto on_y = [&](std::uint32_t row) { visit(Neighbour{std::size_t{row} * map_.columns + i, y}); };
    if (i > 0 || map_.periodic) on_x(i > 0 ? i - 1 : map_.columns - 1);
    if (i + 1 < map_.columns || map_.periodic) on_x(i + 1 < map_.columns ? i + 1 : 0);
    if (j > 0 || map_.periodic) on_y(j > 0 ? j - 1 : map_.rows - 1);
    if (j + 1 < map_.rows || map_.periodic) on_y(j + 1 < map_.rows ? j + 1 : 0);
  }

 private:
  const HeightMap& map_;
};

void require_some_height(const HeightMap& map, std::uint64_t missing) {
  if (missing == map.heights_um.size())
    throw core::InputError(
        {{}, "height map in which every point is missing; expected at least one height", ""});
}

}  // namespace

std::uint64_t count_missing(const HeightMap& map) {
  return static_cast<std::uint64_t>(
      std::count_if(map.heights_um.begin(), map.heights_um.end(), [](double h) { return std::isnan(h); }));
}

std::uint64_t remove_outliers(HeightMap& map, double limit, int radius) {
  if (!(limit >= 1.0 && std::isfinite(limit)))
    throw core::InputError({{},
                            fmt::format("outliers beyond {} standard deviations; expected 1 or more", limit),
                            "6 removes almost nothing from a Gaussian surface"});
  require_some_height(map, count_missing(map));
  HeightMap smooth = map;
  filter_median(smooth, radius);
  std::vector<double> deviations;
  deviations.reserve(map.heights_um.size());
  for (std::size_t k = 0; k < map.heights_um.size(); ++k)
    if (!std::isnan(map.heights_um[k]))
      deviations.push_back(std::abs(map.heights_um[k] - smooth.heights_um[k]));
  const double most = limit * robust_deviation(deviations);
  std::uint64_t taken = 0;
  for (std::size_t k = 0; k < map.heights_um.size(); ++k)
    if (std::abs(map.heights_um[k] - smooth.heights_um[k]) > most) {
      map.heights_um[k] = std::numeric_limits<double>::quiet_NaN();
      ++taken;
    }
  map.steps.push_back(
      fmt::format("{} outliers removed, farther than {:.6g} robust standard deviations ({:.4g} um) from "
                  "the median within {} pixels",
                  taken, limit, most, radius));
  return taken;
}

void fill_missing(HeightMap& map) {
  const std::uint64_t missing = count_missing(map);
  if (missing == 0) return;
  require_some_height(map, missing);
  if (missing > kMostToFill)
    throw core::InputError({{},
                            fmt::format("{} missing points; at most {} can be filled", missing, kMostToFill),
                            "crop the map"});
  constexpr Eigen::Index kKnown = -1;
  std::vector<Eigen::Index> unknown(map.heights_um.size(), kKnown);
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < map.heights_um.size(); ++k)
    if (std::isnan(map.heights_um[k])) {
      unknown[k] = static_cast<Eigen::Index>(points.size());
      points.push_back(k);
    }
  const auto size = static_cast<Eigen::Index>(points.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  const Grid grid(map);
  for (Eigen::Index row = 0; row < size; ++row) {
    double diagonal = 0.0;
    grid.neighbours(points[static_cast<std::size_t>(row)], [&](const Neighbour& neighbour) {
      diagonal += neighbour.weight;
      if (unknown[neighbour.point] == kKnown)
        right[row] += neighbour.weight * map.heights_um[neighbour.point];
      else
        entries.emplace_back(row, unknown[neighbour.point], -neighbour.weight);
    });
    entries.emplace_back(row, row, diagonal);
  }
  Eigen::SparseMatrix<double> laplace(size, size);
  laplace.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplace);
  if (solver.info() != Eigen::Success) throw core::InternalError("the matrix of missing points is singular");
  const Eigen::VectorXd heights = solver.solve(right);
  for (Eigen::Index row = 0; row < size; ++row)
    map.heights_um[points[static_cast<std::size_t>(row)]] = heights[row];
  map.steps.push_back(fmt::format("{} missing points filled by Laplace interpolation", missing));
}

}  // namespace scintray::topography
