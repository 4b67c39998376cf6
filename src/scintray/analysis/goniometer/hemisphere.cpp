#include "scintray/analysis/goniometer/hemisphere.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::analysis {

namespace {

constexpr double kRingStep = 0.5 * core::kPi / HemisphereGrid::kRings;

}  // namespace

HemisphereGrid::HemisphereGrid() : first_{0} {
  for (int ring = 0; ring < kRings; ++ring) {
    const double circumference = core::kTwoPi * std::sin((ring + 0.5) * kRingStep);
    const auto cells = static_cast<std::size_t>(std::max(3.0, std::round(circumference / kRingStep)));
    first_.push_back(first_.back() + cells);
  }
}

std::size_t HemisphereGrid::cell_at(double polar_rad, double azimuth_rad) const {
  const auto ring =
      static_cast<std::size_t>(std::clamp(static_cast<int>(polar_rad / kRingStep), 0, kRings - 1));
  const std::size_t cells = first_[ring + 1] - first_[ring];
  const double turns = azimuth_rad / core::kTwoPi;
  const double at = (turns - std::floor(turns)) * static_cast<double>(cells) + 0.5;
  return first_[ring] + static_cast<std::size_t>(at) % cells;
}

HemisphereGrid::Cell HemisphereGrid::cell(std::size_t index) const {
  const auto ring = std::upper_bound(first_.begin(), first_.end(), index) - first_.begin() - 1;
  const auto r = static_cast<std::size_t>(ring);
  const double step = core::kTwoPi / static_cast<double>(first_[r + 1] - first_[r]);
  Cell cell;
  cell.polar_low = static_cast<double>(r) * kRingStep;
  cell.polar_high = static_cast<double>(r + 1) * kRingStep;
  cell.azimuth_low = (static_cast<double>(index - first_[r]) - 0.5) * step;
  cell.azimuth_high = cell.azimuth_low + step;
  cell.solid_angle_sr = step * (std::cos(cell.polar_low) - std::cos(cell.polar_high));
  return cell;
}

const HemisphereGrid& hemisphere_grid() {
  static const HemisphereGrid grid;
  return grid;
}

DirectionCounts::DirectionCounts() : cells(hemisphere_grid().size(), 0), profile(kProfileBins, 0) {}

void DirectionCounts::add(double forward, double across, double along, double sin_half_width) {
  const double polar = std::acos(std::clamp(along, 0.0, 1.0));
  ++cells[hemisphere_grid().cell_at(polar, std::atan2(across, forward))];
  if (std::abs(across) > sin_half_width) return;
  const double in_plane = std::atan2(forward, along) / core::kDegree;
  const int bin = static_cast<int>(std::floor(in_plane - profile_edge_deg(0)));
  ++profile[static_cast<std::size_t>(std::clamp(bin, 0, kProfileBins - 1))];
}

void DirectionCounts::merge(const DirectionCounts& other) {
  for (std::size_t k = 0; k < cells.size(); ++k) cells[k] += other.cells[k];
  for (std::size_t k = 0; k < profile.size(); ++k) profile[k] += other.profile[k];
}

std::uint64_t DirectionCounts::total() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : cells) sum += count;
  return sum;
}

core::Estimate density_per_sr(std::uint64_t count, std::uint64_t rays, double solid_angle_sr) {
  const core::Estimate share = core::binomial_estimate(count, rays);
  return {share.value / solid_angle_sr, share.error / solid_angle_sr};
}

double profile_bin_sr(double half_width_rad) {
  return 2.0 * std::sin(half_width_rad) * core::kPi / DirectionCounts::kProfileBins;
}

}  // namespace scintray::analysis
