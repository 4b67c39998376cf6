#pragma once
/// Tables of numbers in CSV files.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::config {

/// A table of numbers: its rows, and the names of its columns if the file has a heading.
struct CsvTable {
  struct Row {
    long line = 0;
    std::vector<double> values;
  };
  std::string file;
  std::vector<std::string> columns;  ///< empty without a heading
  std::vector<Row> rows;             ///< one at least, all equally long

  /// Index of the named column, or `standard` when the name is empty. Throws InputError at `where`
  /// when there is no such column.
  std::size_t column(const std::string& name, std::size_t standard, const core::FileLocation& where) const;
};

/// Table of the comma-separated numbers in a file, one row per line. The first row may be a heading; empty
/// lines and lines that start with # are skipped. Throws InputError with every row that is wrong.
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace scintray::config
