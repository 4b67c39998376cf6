#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "scintray/config/csv.hpp"
#include "scintray/config/toml_reader.hpp"

namespace scintray::config {

namespace {

std::string name_of_x(core::Dimension x) {
  return x == core::Dimension::dimensionless ? "x" : core::dimension_name(x);
}

/// The value of a bare number given in `unit`.
double in_unit(double value, const std::string& unit, core::Dimension dimension) {
  if (unit.empty()) return value;
  std::ostringstream text;
  text.precision(17);
  text << value << ' ' << unit;
  return core::parse_quantity(text.str(), dimension);
}

struct Samples {
  std::vector<double> values;
  std::vector<core::FileLocation> where;
};

}  // namespace

core::Curve TomlTable::curve(const std::string& key, core::Dimension y, core::Dimension x) const {
  read(key, true);
  return optional_curve(key, y, x).value_or(core::Curve::constant(0.0));
}

std::optional<core::Curve> TomlTable::optional_curve(const std::string& key, core::Dimension y,
                                                     core::Dimension x) const {
  record(key, {.form = KeyUse::Form::curve, .dimension = y, .x = x});
  const TomlNode* value = read(key, false);
  if (!value) return std::nullopt;
  if (value->kind == TomlNode::Kind::table) return curve_of(key, *value, y, x);
  if (value->kind == TomlNode::Kind::array) {
    report_at(value->where, key, quoted(key) + " is an array, but one value or a table is expected",
              "write { " + name_of_x(x) + " = [...], value = [...] }");
    return std::nullopt;
  }
  const std::optional<double> constant = quantity_of(key, *value, y);
  return constant ? std::optional<core::Curve>(core::Curve::constant(*constant)) : std::nullopt;
}

std::optional<core::Curve> TomlTable::curve_of(const std::string& key, const TomlNode& value,
                                               core::Dimension y, core::Dimension x) const {
  const TomlTable table = child(value, key);
  const std::string x_key = name_of_x(x);
  const std::size_t problems_before = problem_count();

  const auto unit = [&](const std::string& unit_key, core::Dimension dimension, bool required) {
    const std::string name = required ? table.string(unit_key) : table.string(unit_key, "");
    if (name.empty() || !table.good(unit_key)) return name;
    try {
      in_unit(1.0, name, dimension);
    } catch (const core::InputError& error) {
      for (const core::Problem& problem : error.problems())
        table.report(unit_key, problem.what, problem.hint);
    }
    return name;
  };
  // Either strings with units, or bare numbers and one unit for all.
  const auto column = [&](const std::string& column_key, core::Dimension dimension) {
    Samples samples;
    const std::string unit_key = column_key + "_unit";
    const bool in_one_unit = table.has(unit_key);
    if (in_one_unit) {
      const std::string name = unit(unit_key, dimension, true);
      samples.values = table.numbers(column_key);
      if (table.good(unit_key))
        for (double& number : samples.values) number = in_unit(number, name, dimension);
    } else {
      samples.values = table.quantities(column_key, dimension);
    }
    const TomlNode* list = table.node_->find(column_key);
    for (std::size_t i = 0; i < samples.values.size(); ++i) samples.where.push_back(list->items[i].where);
    return samples;
  };

  Samples xs, ys;
  for (const std::string& known : {x_key, std::string("value"), x_key + "_unit", std::string("value_unit"),
                                   std::string("file"), x_key + "_column", std::string("value_column")})
    table.has(known);
  const std::optional<std::string> form = table.one_of({x_key, "file"}, true);
  if (!form) {
    table.skip();
  } else if (*form == x_key) {
    xs = column(x_key, x);
    ys = column("value", y);
  } else {
    const std::filesystem::path file = table.existing_file("file");
    const std::string x_unit = unit(x_key + "_unit", x, x != core::Dimension::dimensionless);
    const std::string y_unit = unit("value_unit", y, y != core::Dimension::dimensionless);
    const std::string x_column = table.string(x_key + "_column", "");
    const std::string y_column = table.string("value_column", "");
    if (problem_count() == problems_before) {
      try {
        const CsvTable csv = read_csv(file);
        const std::size_t x_index = csv.column(x_column, 0, table.where(x_key + "_column"));
        const std::size_t y_index = csv.column(y_column, 1, table.where("value_column"));
        for (const CsvTable::Row& row : csv.rows) {
          xs.values.push_back(in_unit(row.values[x_index], x_unit, x));
          ys.values.push_back(in_unit(row.values[y_index], y_unit, y));
          xs.where.push_back({csv.file, row.line, 1});
        }
      } catch (const core::InputError& error) {
        for (const core::Problem& problem : error.problems())
          report_at(problem.where.file.empty() ? table.where("file") : problem.where, key,
                    quoted(key) + ": " + problem.what, problem.hint);
      }
    }
  }
  if (problem_count() != problems_before) {
    mark_bad(key);
    return std::nullopt;
  }

  if (xs.values.size() != ys.values.size()) {
    report_at(value.where, key,
              quoted(key) + " has " + std::to_string(xs.values.size()) + " values of " + x_key + ", but " +
                  std::to_string(ys.values.size()) + " of \"value\"",
              "give one value for every " + x_key);
    return std::nullopt;
  }
  // Photon energies rise while wavelengths fall.
  if (xs.values.size() > 1 && xs.values.front() > xs.values.back()) {
    std::reverse(xs.values.begin(), xs.values.end());
    std::reverse(xs.where.begin(), xs.where.end());
    std::reverse(ys.values.begin(), ys.values.end());
  }
  for (std::size_t i = 1; i < xs.values.size(); ++i)
    if (!(xs.values[i] > xs.values[i - 1])) {
      report_at(xs.where[i], key, quoted(key) + ": the values of " + x_key + " are not in order here",
                "sort them, rising or falling, each once");
      return std::nullopt;
    }
  try {
    return core::Curve(xs.values, ys.values);
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      report_at(value.where, key, quoted(key) + ": " + problem.what, problem.hint);
    return std::nullopt;
  }
}

}  // namespace scintray::config
