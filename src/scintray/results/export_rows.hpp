#pragma once
/// Rows of a results file for other programs.

#include <cstdint>
#include <filesystem>
#include <string>

namespace scintray::results {

/// Writes a table of a results file (photons, events, signals, paths, path_steps) as columns of 64-bit
/// floating-point numbers, with the names of the results file.
///
/// The extension of the output selects the form: .csv, with a heading; .npy, a structured array of NumPy
/// with a field per column; .lh5, HDF5 with the attributes of LEGEND's data format (datatype "table{...}" of
/// the group, "array<1>{real}" and units of the columns; legend-data-format-specs, "HDF5 File Format").
/// @param table  group of the results file
/// @return number of rows
/// @throws InputError for a file that is no result, a table that it does not have, and another extension
std::uint64_t export_rows(const std::filesystem::path& results, const std::string& table,
                          const std::filesystem::path& output);

}  // namespace scintray::results
