#include "scintray/config/columns.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "scintray/config/csv.hpp"
#include "scintray/config/detail/npy.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/words.hpp"

namespace scintray::config {

namespace {

constexpr core::Word<ColumnFormat> kFormats[] = {{".csv", ColumnFormat::csv},   {".h5", ColumnFormat::hdf5},
                                                 {".hdf5", ColumnFormat::hdf5}, {".lh5", ColumnFormat::hdf5},
                                                 {".npy", ColumnFormat::numpy}, {".npz", ColumnFormat::npz}};

Columns read_csv_columns(const ColumnFile& file, const std::vector<std::string>& names) {
  const CsvTable table = read_csv(file.path);
  std::vector<std::optional<std::size_t>> at;
  for (const std::string& name : names)
    at.push_back(name.empty() ? std::nullopt : std::optional(table.column(name, 0, file.where)));
  Columns columns;
  columns.values.resize(names.size());
  for (const CsvTable::Row& row : table.rows) {
    for (std::size_t i = 0; i < at.size(); ++i)
      if (at[i]) columns.values[i].push_back(row.values[*at[i]]);
    columns.rows.push_back(static_cast<std::uint64_t>(row.line));
  }
  return columns;
}

core::InputError unequal(const ColumnFile& file, const std::string& name, const std::string& first) {
  return core::InputError({file.where,
                           "the dataset \"" + name + "\" of " + file.path.string() +
                               " is not a column as long as \"" + first + "\"",
                           "give one-dimensional datasets of equal length, one a column"});
}

Columns read_hdf5_columns(const ColumnFile& file, const std::vector<std::string>& names) {
  const core::h5::File opened = core::h5::File::open(file.path);
  const core::h5::Group root = opened.root();
  if (!file.group.empty() && !root.has(file.group))
    throw core::unknown_name(file.where, "group of the file", file.group, root.members());
  const core::h5::Group group = file.group.empty() ? root : root.open_group(file.group);
  Columns columns;
  columns.values.resize(names.size());
  std::string first;
  std::size_t length = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) continue;
    if (!group.has(names[i])) throw core::unknown_name(file.where, "dataset", names[i], group.members());
    const core::h5::Shape shape = group.shape(names[i]);
    if (first.empty()) {
      first = names[i];
      length = shape.size() == 1 ? shape[0] : 0;
    }
    if (shape.size() != 1 || shape[0] != length) throw unequal(file, names[i], first);
    columns.values[i] = group.read<double>(names[i]);
  }
  columns.rows.resize(length);
  std::iota(columns.rows.begin(), columns.rows.end(), std::uint64_t{0});
  return columns;
}

Columns read_numpy_columns(const ColumnFile& file, const std::vector<std::string>& names) {
  Columns columns;
  columns.values.resize(names.size());
  const NumpyFile arrays(file);
  std::string first;
  std::size_t length = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) continue;
    columns.values[i] = arrays.column(names[i]);
    if (first.empty()) {
      first = names[i];
      length = columns.values[i].size();
    }
    if (columns.values[i].size() != length) throw unequal(file, names[i], first);
  }
  columns.rows.resize(length);
  std::iota(columns.rows.begin(), columns.rows.end(), std::uint64_t{0});
  return columns;
}

}  // namespace

bool is_column_file(const std::filesystem::path& path) {
  return core::find_word(kFormats, path.extension().string()).has_value();
}

ColumnFormat column_format(const std::filesystem::path& path) {
  const std::optional<ColumnFormat> format = core::find_word(kFormats, path.extension().string());
  if (!format) throw core::InternalError("\"" + path.string() + "\" is no file of columns");
  return *format;
}

Columns read_columns(const ColumnFile& file, const std::vector<std::string>& names) {
  switch (column_format(file.path)) {
    case ColumnFormat::csv:
      return read_csv_columns(file, names);
    case ColumnFormat::hdf5:
      return read_hdf5_columns(file, names);
    case ColumnFormat::numpy:
    case ColumnFormat::npz:
      break;
  }
  return read_numpy_columns(file, names);
}

}  // namespace scintray::config
