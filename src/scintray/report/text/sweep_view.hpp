#pragma once
/// A sweep as curves: one numeric key along the axis, one series for each setting of the others.

#include <optional>
#include <string>
#include <vector>

#include "scintray/tally/result.hpp"

namespace scintray::report {

struct SweepSeries {
  std::string label;  ///< settings of the other keys, empty when there are none
  std::vector<double> x;
  std::vector<std::size_t> points;  ///< indices into RunResult::points, in step with x
};

struct SweepView {
  std::string key;                  ///< "source.region.slab_z.center"
  std::string unit;                 ///< "mm"; empty for a plain number
  std::vector<std::string> rows;    ///< distinct values of the key as written, by size
  std::vector<double> row_values;   ///< in step with rows
  std::vector<SweepSeries> series;  ///< in order of appearance
};

/// View of a sweep over the last key that is a number with one unit throughout and two values or more; empty
/// when there is none.
std::optional<SweepView> view_sweep(const tally::RunResult& run);

/// "rough, 2 mm": the settings of a point; "run" without a sweep.
std::string point_label(const tally::PointResult& point);

}  // namespace scintray::report
