#pragma once
/// Measured in-plane profiles, for comparison with readings.

#include <filesystem>
#include <vector>

#include "scintray/analysis/goniometer/hemisphere.hpp"

namespace scintray::analysis {

/// Light against the angle in the plane of incidence, in any unit.
struct MeasuredProfile {
  std::vector<double> angle_deg;  ///< increasing, forward positive, from -90 to 90
  std::vector<double> value;      ///< not negative
  std::vector<double> error;      ///< one sigma; empty when the file has none
};

/// Profile of a CSV file with rows of angle_deg, value and optionally error, with or without a heading.
/// InputError with every row that is wrong: not two or three columns, angles outside [-90, 90] or not
/// increasing, values or errors below 0, fewer than two rows, no value above 0.
MeasuredProfile read_measured_profile(const std::filesystem::path& path);

/// A measurement scaled to a reading.
struct ScaledProfile {
  MeasuredProfile profile;  ///< per sr
  double factor = 1.0;      ///< factor applied to the measurement
  double rms = 0.0;  ///< root mean square difference to the reading, as a share of the reading's largest
};

/// Measurement scaled to the reading: to the same area under both curves between the first and the last
/// measured angle, by trapezoids over the measured angles; the reading is linear between the middles of its
/// bins. InputError when the reading has no light there.
ScaledProfile scale_to(const MeasuredProfile& measured, const DirectionCounts& reading, std::uint64_t rays,
                       double half_width_rad);

}  // namespace scintray::analysis
