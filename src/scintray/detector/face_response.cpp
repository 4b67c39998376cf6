#include "scintray/detector/face_response.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::detector {

namespace {

/// Grid point before a place, and the share of the next.
struct GridCell {
  std::size_t before;
  double share;
};

GridCell grid_cell(double place, double first, double pitch, std::size_t points) {
  const double at = std::clamp((place - first) / pitch, 0.0, static_cast<double>(points - 1));
  const std::size_t before = std::min(static_cast<std::size_t>(at), points - 2);
  return {before, at - static_cast<double>(before)};
}

}  // namespace

double FaceGrid::at(double x, double y) const {
  const GridCell column = grid_cell(x, x_mm, pitch_x_mm, columns), row = grid_cell(y, y_mm, pitch_y_mm, rows);
  const double* corner = factor.data() + row.before * columns + column.before;
  return std::lerp(std::lerp(corner[0], corner[1], column.share),
                   std::lerp(corner[columns], corner[columns + 1], column.share), row.share);
}

FaceResponse FaceResponse::radial(core::Curve factor) {
  FaceResponse response;
  response.radial_ = std::move(factor);
  return response;
}

FaceResponse FaceResponse::grid(FaceGrid factors) {
  FaceResponse response;
  response.grid_ = std::move(factors);
  return response;
}

double FaceResponse::at(double x_mm, double y_mm) const {
  return grid_ ? grid_->at(x_mm, y_mm) : radial_(std::hypot(x_mm, y_mm));
}

double FaceResponse::least() const {
  return grid_ ? *std::min_element(grid_->factor.begin(), grid_->factor.end()) : radial_.min_y();
}

double FaceResponse::greatest() const {
  return grid_ ? *std::max_element(grid_->factor.begin(), grid_->factor.end()) : radial_.max_y();
}

}  // namespace scintray::detector
