#pragma once
/// A measured curve for comparison with a simulation.

#include <filesystem>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

/// Values against a position (a depth, an angle), in the units of its file.
struct MeasuredCurve {
  struct Point {
    double x = 0.0;
    core::Estimate y;  ///< the error is 0 when the file has none
    core::FileLocation where;
  };
  std::vector<Point> points;  ///< x increasing
  bool has_errors = false;
};

/// Curve of a CSV file with rows of position, value and optionally error (one sigma), with or without a
/// heading. InputError with every row that is wrong: not two or three columns, positions that do not
/// increase, values below 0, errors that are not above 0; or no value above 0.
MeasuredCurve read_measured_curve(const std::filesystem::path& path);

}  // namespace scintray::analysis
