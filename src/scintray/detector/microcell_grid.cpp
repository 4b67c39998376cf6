#include "scintray/detector/microcell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "scintray/core/error.hpp"

namespace scintray::detector {

namespace {

constexpr double kMostCells = 1e8;

std::uint32_t index_along(double from_edge, double length, std::uint32_t cells) {
  const double index = std::floor(from_edge / length * cells);
  return static_cast<std::uint32_t>(std::clamp(index, 0.0, static_cast<double>(cells - 1)));
}

}  // namespace

MicrocellGrid::MicrocellGrid(const Microcells& cells, const SensorFace& face) : face_(face) {
  if (!(face.area_mm2() > 0.0))
    throw core::InputError(
        {{}, "a sensor whose face has no area", "light must reach the sensor through a face"});
  const double pitch = cells.count > 0 ? std::sqrt(face.area_mm2() / cells.count) : cells.pitch_mm;
  const double columns = std::max(1.0, std::round(face.width_mm / pitch));
  const double rows =
      cells.count > 0 ? std::ceil(cells.count / columns) : std::max(1.0, std::round(face.height_mm / pitch));
  if (!(columns * rows <= kMostCells))
    throw core::InputError({{},
                            "a sensor of " + std::to_string(face.width_mm) + " by " +
                                std::to_string(face.height_mm) + " mm with more than 10^8 cells",
                            "check the pitch of the cells and the size of the sensor"});
  columns_ = static_cast<std::uint32_t>(columns);
  rows_ = static_cast<std::uint32_t>(rows);
  count_ = cells.count > 0 ? cells.count : columns_ * rows_;
}

std::uint32_t MicrocellGrid::any(core::Rng& rng) const {
  return static_cast<std::uint32_t>(rng.uniform() * count_);
}

std::uint32_t MicrocellGrid::at(const Arrival& arrival, core::Rng& rng) const {
  if (std::isnan(arrival.x_mm) || std::isnan(arrival.y_mm)) return any(rng);
  const std::uint32_t column = index_along(arrival.x_mm + 0.5 * face_.width_mm, face_.width_mm, columns_);
  const std::uint32_t row = index_along(arrival.y_mm + 0.5 * face_.height_mm, face_.height_mm, rows_);
  return std::min(row * columns_ + column, count_ - 1);
}

std::span<const std::uint32_t> MicrocellGrid::neighbours(std::uint32_t cell,
                                                         std::array<std::uint32_t, 8>& buffer) const {
  const std::uint32_t row = cell / columns_, column = cell % columns_;
  std::size_t found = 0;
  for (std::uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, rows_ - 1); ++r)
    for (std::uint32_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, columns_ - 1); ++c) {
      const std::uint32_t other = r * columns_ + c;
      if (other != cell && other < count_) buffer[found++] = other;
    }
  return {buffer.data(), found};
}

}  // namespace scintray::detector
