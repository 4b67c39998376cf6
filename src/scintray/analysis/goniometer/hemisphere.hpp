#pragma once
/// Counts of directions over a hemisphere, in cells of nearly equal solid angle.

#include <cstdint>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

/// Cells of a hemisphere: rings of equal steps of the polar angle, each divided into equal steps of azimuth
/// so that a cell has about equal width and height. Azimuth 0 is the middle of a ring's first cell, so the
/// plane of incidence is not on an edge of a cell there.
class HemisphereGrid {
 public:
  static constexpr int kRings = 45;  ///< of 2 deg

  /// One cell; angles in rad, azimuths may pass 2 pi.
  struct Cell {
    double polar_low = 0.0, polar_high = 0.0;
    double azimuth_low = 0.0, azimuth_high = 0.0;
    double solid_angle_sr = 0.0;  ///< the cells' sum is 2 pi
  };

  HemisphereGrid();
  std::size_t size() const { return first_.back(); }
  /// Cell of a polar angle in [0, pi/2] and an azimuth (rad).
  std::size_t cell_at(double polar_rad, double azimuth_rad) const;
  Cell cell(std::size_t index) const;

 private:
  std::vector<std::size_t> first_;  ///< index of each ring's first cell, and the number of all
};

/// The grid common to all readings.
const HemisphereGrid& hemisphere_grid();

/// Directions on one side, as measured by a goniometer: polar angle from that side's outward normal;
/// azimuth 0 forward, in the plane of incidence, on the side of specular reflection and of refraction.
struct DirectionCounts {
  /// Bins of the in-plane profile: 1 deg from -90 to 90 deg, forward positive.
  static constexpr int kProfileBins = 180;

  std::vector<std::uint64_t> cells;    ///< in the order of hemisphere_grid()
  std::vector<std::uint64_t> profile;  ///< light within the profile's half-width of the plane

  DirectionCounts();
  /// `forward`, `across`, `along` are the direction's components (unit length, `along` >= 0 along the
  /// side's outward normal); it counts in the profile when |across| <= sine of the half-width.
  void add(double forward, double across, double along, double sin_half_width);
  void merge(const DirectionCounts& other);
  /// Number of rays that left on this side.
  std::uint64_t total() const;
};

/// Density in a cell or a profile's bin: share of the incident rays, per sr, with its binomial error.
core::Estimate density_per_sr(std::uint64_t count, std::uint64_t rays, double solid_angle_sr);

/// Solid angle (sr) of one bin of the in-plane profile: the band |across| <= sin(half_width), cut at
/// equal steps of the angle in the plane, 2 sin(half_width) x the step.
double profile_bin_sr(double half_width_rad);
/// Edge k in [0, kProfileBins] of the profile, deg.
constexpr double profile_edge_deg(int k) { return -90.0 + k; }

}  // namespace scintray::analysis
