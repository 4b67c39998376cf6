#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scintray/config/csv.hpp"
#include "scintray/core/units.hpp"
#include "scintray/materials/detail/forms.hpp"
#include "scintray/materials/detail/sensor_parts.hpp"

namespace scintray::materials {

namespace {

/// Equally spaced values of a column, rising.
struct Axis {
  std::vector<double> places;
  double pitch = 0.0;
};

/// Largest deviation from equal spacing, relative to the pitch.
constexpr double kUneven = 1e-3;

Axis axis_of(const config::CsvTable& table, std::size_t column, const char* name) {
  std::vector<double> all;
  for (const config::CsvTable::Row& row : table.rows) all.push_back(row.values[column]);
  std::sort(all.begin(), all.end());
  const double span = all.back() - all.front();
  Axis axis;
  for (const double place : all)
    if (axis.places.empty() || place - axis.places.back() > 1e-9 * span) axis.places.push_back(place);
  const core::FileLocation where{table.file, table.rows.front().line};
  if (axis.places.size() < 2)
    throw core::InputError({where, fmt::format("all values of \"{}\" are the same", name),
                            "a map of a face has two columns and two rows of points at least"});
  axis.pitch = span / static_cast<double>(axis.places.size() - 1);
  for (std::size_t i = 0; i < axis.places.size(); ++i)
    if (std::abs(axis.places[i] - axis.places.front() - axis.pitch * static_cast<double>(i)) >
        kUneven * axis.pitch)
      throw core::InputError({where,
                              fmt::format("the values of \"{}\" are not equally spaced: {:g} follows {:g}, "
                                          "with a mean step of {:g}",
                                          name, axis.places[i], axis.places[i - 1], axis.pitch),
                              "give the factors on a uniform grid"});
  return axis;
}

/// The uniform grid of a table of x, y and factor, in any order. Throws InputError at the wrong line.
detector::FaceGrid read_grid(const std::filesystem::path& path, double mm_per_unit) {
  const config::CsvTable table = config::read_csv(path);
  const core::FileLocation where{table.file, table.rows.front().line};
  if (table.rows.front().values.size() < 3)
    throw core::InputError({where, "a map of a face has three columns", "give x, y and the factor"});
  const auto column = [&](const char* name, std::size_t standard) {
    return table.column(table.columns.empty() ? "" : name, standard, where);
  };
  const std::size_t at_x = column("x", 0), at_y = column("y", 1), at_factor = column("factor", 2);
  const Axis x = axis_of(table, at_x, "x"), y = axis_of(table, at_y, "y");
  detector::FaceGrid grid{x.places.front() * mm_per_unit,
                          y.places.front() * mm_per_unit,
                          x.pitch * mm_per_unit,
                          y.pitch * mm_per_unit,
                          x.places.size(),
                          y.places.size(),
                          {}};
  core::Problems problems;
  std::map<std::size_t, double> factors;  // by their place in the grid, which may be far larger than the file
  for (const config::CsvTable::Row& row : table.rows) {
    const auto i = static_cast<std::size_t>(std::lround((row.values[at_x] - x.places.front()) / x.pitch));
    const auto j = static_cast<std::size_t>(std::lround((row.values[at_y] - y.places.front()) / y.pitch));
    const double factor = row.values[at_factor];
    if (!(factor >= 0.0))
      problems.add({table.file, row.line}, fmt::format("the factor is {:g}", factor),
                   "a factor on the efficiency is 0 or more");
    else if (!factors.try_emplace(j * grid.columns + i, factor).second)
      problems.add({table.file, row.line},
                   fmt::format("the point ({:g}, {:g}) occurs twice", row.values[at_x], row.values[at_y]),
                   "give each point once");
  }
  problems.throw_if_any();
  for (const auto& [place, factor] : factors) {
    if (place != grid.factor.size()) break;
    grid.factor.push_back(factor);
  }
  if (grid.factor.size() < grid.columns * grid.rows) {
    const std::size_t missing = grid.factor.size();
    throw core::InputError(
        {where,
         fmt::format("the grid of {} x {} points has none at ({:g}, {:g})", grid.columns, grid.rows,
                     x.places[missing % grid.columns], y.places[missing / grid.columns]),
         "give every point of the grid, outside the sensor with the factor 0"});
  }
  return grid;
}

void read_map(const config::TomlTable& uniformity, detector::Sensor& sensor) {
  const config::TomlTable map = uniformity.table("map");
  const std::filesystem::path path = map.existing_file("file");
  const std::string unit = map.string("unit");
  if (path.empty() || !map.good("unit")) return;
  try {
    sensor.over_face =
        detector::FaceResponse::grid(read_grid(path, core::unit_factor(unit, core::Dimension::length)));
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      map.report(problem.where.file.empty() ? "unit" : "file",
                 (problem.where.file.empty() ? "" : problem.where.text() + ": ") + problem.what,
                 problem.hint);
  }
}

void read_radial(const config::TomlTable& uniformity, detector::Sensor& sensor) {
  core::Curve factor = uniformity.curve("radial", core::Dimension::dimensionless, core::Dimension::length);
  uniformity.expect("radial", !factor.is_constant(), "a dependence on the place needs distances",
                    "write { length = [0, 20], length_unit = \"mm\", value = [1, 0.9] }");
  uniformity.expect("radial", factor.min_y() >= 0.0, "a factor of efficiency cannot be negative");
  uniformity.expect("radial", factor.x().front() >= 0.0, "a distance from the middle cannot be negative");
  if (uniformity.good("radial")) sensor.over_face = detector::FaceResponse::radial(std::move(factor));
}

using FaceReader = void (*)(const config::TomlTable& uniformity, detector::Sensor& sensor);
constexpr core::Word<FaceReader> kFaceForms[] = {{"radial", read_radial}, {"map", read_map}};

}  // namespace

void read_face_response(const config::TomlTable& uniformity, detector::Sensor& sensor) {
  const auto* form = uniformity.one_of(kFaceForms, true);
  if (!form) return;
  form->value(uniformity, sensor);
  if (!sensor.over_face) return;
  const double greatest = sensor.over_face->greatest();
  double highest = 0.0;
  for (const double nm : sensor.efficiency.x())
    highest = std::max(highest, sensor.conversion_probability(nm));
  uniformity.expect(form->word, greatest > 0.0, "the sensor would detect nothing: every factor is 0");
  uniformity.expect(form->word, highest * greatest <= 1.0 + 1e-9,
                    fmt::format("with this factor more photons are converted than arrive ({:.3g} of them at "
                                "most)",
                                highest * greatest),
                    "give the factor relative to the efficiency: 1 where that was measured");
}

}  // namespace scintray::materials
