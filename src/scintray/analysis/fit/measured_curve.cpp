#include "scintray/analysis/fit/measured_curve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/config/csv.hpp"

namespace scintray::analysis {

MeasuredCurve read_measured_curve(const std::filesystem::path& path) {
  const config::CsvTable table = config::read_csv(path);
  const std::size_t width = table.rows.front().values.size();
  if (width != 2 && width != 3)
    throw core::InputError(
        {{table.file, table.rows.front().line, 1},
         fmt::format("rows of {} values; expected position,value or position,value,error", width),
         "remove the other columns"});
  core::Problems problems;
  MeasuredCurve curve;
  curve.has_errors = width == 3;
  for (const config::CsvTable::Row& row : table.rows) {
    const MeasuredCurve::Point point{
        row.values[0], {row.values[1], curve.has_errors ? row.values[2] : 0.0}, {table.file, row.line, 0}};
    if (!curve.points.empty() && point.x <= curve.points.back().x)
      problems.add(point.where,
                   fmt::format("a position of {:g} after {:g}; expected them to increase", point.x,
                               curve.points.back().x),
                   "sort the rows by position, each position once");
    if (point.y.value < 0.0)
      problems.add(point.where, fmt::format("a value of {:g}; expected 0 or more", point.y.value),
                   "light and reflectance are not negative: leave the row out");
    if (curve.has_errors && !(point.y.error > 0.0))
      problems.add(point.where, fmt::format("an error of {:g}; expected more than 0", point.y.error),
                   "give one standard deviation; where no errors are known, leave the whole column away and "
                   "write errors = \"from_scatter\" in [fit]");
    curve.points.push_back(point);
  }
  if (std::none_of(curve.points.begin(), curve.points.end(),
                   [](const MeasuredCurve::Point& point) { return point.y.value > 0.0; }))
    problems.add({table.file, 0, 0}, "no value above 0", "without light there is nothing to compare");
  problems.throw_if_any();
  return curve;
}

}  // namespace scintray::analysis
