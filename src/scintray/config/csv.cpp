#include "scintray/config/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/text.hpp"

namespace scintray::config {

namespace {

struct Cell {
  std::string text;
  long column = 1;
};

std::vector<Cell> cells_of(const std::string& line) {
  std::vector<Cell> cells;
  std::size_t start = 0;
  while (start <= line.size()) {
    const std::size_t end = std::min(line.find(',', start), line.size());
    std::size_t first = start;
    std::size_t last = end;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    if (last - first >= 2 && line[first] == '"' && line[last - 1] == '"') {
      ++first;
      --last;
    }
    cells.push_back({line.substr(first, last - first), static_cast<long>(first) + 1});
    start = end + 1;
  }
  return cells;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::size_t CsvTable::column(const std::string& name, std::size_t standard,
                             const core::FileLocation& where) const {
  const std::size_t width = rows.front().values.size();
  if (name.empty()) {
    if (standard < width) return standard;
    throw core::InputError({where,
                            "the table \"" + file + "\" has " + std::to_string(width) + " column, but " +
                                std::to_string(standard + 1) + " are needed",
                            "separate the columns by commas"});
  }
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  throw core::InputError({where, "the table \"" + file + "\" has no column \"" + name + "\"",
                          columns.empty() ? "the file has no heading: name the columns in its first line"
                                          : "its columns are " + core::list_of(columns)});
}

CsvTable read_csv(const std::filesystem::path& path) {
  CsvTable table;
  table.file = path.string();
  core::Problems problems;
  std::istringstream stream(read_text_file(path));
  std::string line;
  std::size_t width = 0;
  for (long number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::vector<Cell> cells = cells_of(line);
    CsvTable::Row row{number, {}};
    const Cell* wrong = nullptr;
    for (const Cell& cell : cells) {
      const std::optional<double> value = number_of(cell.text);
      if (!value && !wrong) wrong = &cell;
      row.values.push_back(value.value_or(0.0));
    }
    if (wrong && width == 0) {
      for (const Cell& cell : cells) table.columns.push_back(cell.text);
      width = cells.size();
      continue;
    }
    if (width == 0) width = cells.size();
    if (wrong)
      problems.add({table.file, number, wrong->column}, "\"" + wrong->text + "\" is not a finite number",
                   "write numbers with a point, separated by commas; start a comment line with #");
    else if (cells.size() != width)
      problems.add({table.file, number, 1},
                   "this row has " + std::to_string(cells.size()) + " values, but " + std::to_string(width) +
                       " are expected",
                   "give every row as many values as the first");
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty())
    problems.add({table.file, 0, 0}, "the table has no rows of numbers", "give one row at least");
  problems.throw_if_any();
  return table;
}

}  // namespace scintray::config
