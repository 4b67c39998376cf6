#pragma once
/// Columns of numbers in files of other programs: CSV, HDF5 and NumPy.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::config {

/// A file of columns, as a scene names it.
struct ColumnFile {
  std::filesystem::path path;
  std::string group{};         ///< of an HDF5 file, with the columns; empty: its root
  core::FileLocation where{};  ///< that names the file, for messages
};

/// Kinds of files of columns, by extension.
enum class ColumnFormat {
  csv,    ///< .csv, with a heading
  hdf5,   ///< .h5, .hdf5 (LH5 files have these extensions or .lh5): a one-dimensional dataset per column
  numpy,  ///< .npy, a structured array of fields, or numbers of which the first axis is the row
  npz     ///< .npz, a one-dimensional array per column
};
/// Extensions of files of columns, for messages.
inline constexpr const char* kColumnExtensions = ".csv, .h5, .hdf5, .lh5, .npy or .npz";
/// Format of a file. @throws InternalError for another extension (is_column_file)
ColumnFormat column_format(const std::filesystem::path& path);
/// True for a file with one of these extensions.
bool is_column_file(const std::filesystem::path& path);

/// Columns of equal length.
struct Columns {
  std::vector<std::vector<double>> values;  ///< one per name requested; empty for an empty name
  std::vector<std::uint64_t> rows;          ///< line of a CSV file; else the number of the row, from 0
};

/// Columns of a file by their names, in the order of the names. In a NumPy array without fields a name is the
/// number of the column, from 0; axes after the first count as one, the last fastest.
/// @param names  an empty one requests no column
/// @throws InputError for a missing column, columns of unequal length, and damaged files
Columns read_columns(const ColumnFile& file, const std::vector<std::string>& names);

}  // namespace scintray::config
