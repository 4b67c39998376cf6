#include "scintray/source/detail/event_sources.hpp"

#include <fmt/format.h>
#include <array>
#include <cmath>

#include "scintray/config/csv.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::source {

namespace {

constexpr std::size_t kMostProblems = 10;
constexpr double kGreatestEvent = 9007199254740992.0;  // 2^53: whole numbers are exact up to here

/// The columns in the order event, x, y, z, energy, time; the last is empty without times.
struct Columns {
  std::array<std::vector<double>, 6> values;
  std::vector<std::uint64_t> rows;
};

std::vector<std::string> names_of(const scene_file::HitsSpec& spec) {
  std::vector<std::string> names{spec.event, spec.x, spec.y, spec.z, spec.energy};
  if (spec.time_ns) names.push_back(spec.time);
  return names;
}

Columns read_csv_columns(const scene_file::HitsSpec& spec) {
  const config::CsvTable table = config::read_csv(spec.file);
  const std::vector<std::string> names = names_of(spec);
  std::vector<std::size_t> at;
  for (const std::string& name : names) at.push_back(table.column(name, 0, spec.where));
  Columns columns;
  for (const config::CsvTable::Row& row : table.rows) {
    for (std::size_t i = 0; i < at.size(); ++i) columns.values[i].push_back(row.values[at[i]]);
    columns.rows.push_back(static_cast<std::uint64_t>(row.line));
  }
  return columns;
}

Columns read_hdf5_columns(const scene_file::HitsSpec& spec) {
  const core::h5::File file = core::h5::File::open(spec.file);
  const core::h5::Group root = file.root();
  if (!spec.group.empty() && !root.has(spec.group))
    throw core::unknown_name(spec.where, "group of the file", spec.group, root.members());
  const core::h5::Group group = spec.group.empty() ? root : root.open_group(spec.group);
  const std::vector<std::string> names = names_of(spec);
  Columns columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!group.has(names[i])) throw core::unknown_name(spec.where, "dataset", names[i], group.members());
    core::h5::Shape shape = group.shape(names[i]);
    if (shape.size() != 1 || (i > 0 && shape[0] != columns.values[0].size()))
      throw core::InputError({spec.where,
                              fmt::format("the dataset \"{}\" of {} is not a column as long as \"{}\"",
                                          names[i], spec.file.string(), names[0]),
                              "give one-dimensional datasets of equal length, one a column"});
    columns.values[i] = group.read<double>(names[i]);
  }
  for (std::uint64_t row = 0; row < columns.values[0].size(); ++row) columns.rows.push_back(row);
  return columns;
}

Columns columns_in_memory(const scene_file::HitsSpec& spec) {
  if (!spec.columns)
    throw core::InputError({spec.where, "the hits of this scene come from a program, which did not set them",
                            "run the scene from Python with run(deposits=...), or name a file of hits"});
  const scene_file::HitColumns& given = *spec.columns;
  Columns columns;
  columns.values = {given.event, given.x_mm, given.y_mm, given.z_mm, given.energy_keV, given.time_ns};
  for (const std::vector<double>& column : columns.values)
    if (column.size() != given.event.size() && !(&column == &columns.values.back() && column.empty()))
      throw core::InputError(
          {spec.where,
           fmt::format("the columns of hits differ in length: {} and {}", given.event.size(), column.size()),
           "set one number per hit in each"});
  for (std::uint64_t row = 0; row < given.event.size(); ++row) columns.rows.push_back(row);
  return columns;
}

/// Columns in mm, keV and ns, with the factors of those of a file.
struct Units {
  double mm = 1.0, keV = 1.0, ns = 1.0;
};

/// Fault of a row; empty for a valid one.
std::string fault_of(const Columns& columns, std::size_t i) {
  const double event = columns.values[0][i], energy = columns.values[4][i];
  if (!(event >= 0.0 && event < kGreatestEvent && event == std::floor(event)))
    return fmt::format("the event {} is not a whole number from 0 on", event);
  if (!(energy >= 0.0 && std::isfinite(energy))) return fmt::format("the energy {} is not from 0 on", energy);
  for (const std::vector<double>& column : columns.values)
    if (!column.empty() && !std::isfinite(column[i])) return "a number is not finite";
  return {};
}

}  // namespace

std::string origin_of_hits(const scene_file::HitsSpec& spec) {
  return spec.arrays ? "the calling program" : spec.file.string();
}

std::vector<Hit> read_hits(const scene_file::HitsSpec& spec) {
  const bool csv = !spec.arrays && spec.file.extension() == ".csv";
  const Columns columns = spec.arrays ? columns_in_memory(spec)
                          : csv       ? read_csv_columns(spec)
                                      : read_hdf5_columns(spec);
  const Units units =
      spec.arrays ? Units{} : Units{spec.length_mm, spec.energy_keV, spec.time_ns.value_or(0.0)};
  core::Problems problems;
  std::vector<Hit> hits;
  const auto& [event, x, y, z, energy, time] = columns.values;
  for (std::size_t i = 0; i < columns.rows.size(); ++i) {
    const std::string fault = fault_of(columns, i);
    if (!fault.empty()) {
      if (problems.list().size() < kMostProblems)
        problems.add({origin_of_hits(spec), csv ? static_cast<long>(columns.rows[i]) : 0, 0},
                     (csv ? "" : fmt::format("row {}: ", columns.rows[i])) + fault,
                     spec.arrays ? "set whole event numbers and finite numbers in mm, keV and ns"
                                 : "check which columns are named in [source.columns]");
      continue;
    }
    hits.push_back({static_cast<std::uint64_t>(event[i]), units.mm * core::Vec3(x[i], y[i], z[i]),
                    units.keV * energy[i], time.empty() ? 0.0 : units.ns * time[i], columns.rows[i]});
  }
  problems.throw_if_any();
  if (hits.empty())
    throw core::InputError(
        {spec.where, "there are no hits in " + origin_of_hits(spec), "give one row at least"});
  return hits;
}

}  // namespace scintray::source
