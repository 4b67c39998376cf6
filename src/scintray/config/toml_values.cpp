// Values of a table, one by one and in arrays, with their units.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>

#include "scintray/config/detail/toml_words.hpp"
#include "scintray/config/toml_reader.hpp"

namespace scintray::config {

namespace {

using Kind = TomlNode::Kind;

/// The whole number that a value represents, else an example.
std::string whole_number(const TomlNode& value) {
  constexpr double kLargest = 9007199254740992.0;  // 2^53: every smaller one is exact
  double number = value.number;
  if (value.kind == Kind::string)
    std::from_chars(value.text.data(), value.text.data() + value.text.size(), number);
  const bool whole = number != 0.0 && std::abs(number) < kLargest && number == std::floor(number);
  return whole ? std::to_string(static_cast<std::int64_t>(number)) : "1_000_000";
}

std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return std::isfinite(value) ? text.str() : "";
}

/// A value in the internal unit of its dimension (core/units.hpp) as a quantity with a unit.
std::string in_internal_unit(double value, core::Dimension dimension) {
  if (dimension == core::Dimension::angle && std::isfinite(value))
    return number_text(value * 180.0 / std::numbers::pi) + " deg";
  const std::vector<std::string> units = core::units_of(dimension);
  const auto own = std::find_if(units.begin(), units.end(), [&](const std::string& unit) {
    return core::unit_factor(unit, dimension) == 1.0;
  });
  return number_text(value) + (own == units.end() || !std::isfinite(value) ? "" : " " + *own);
}

}  // namespace

std::optional<std::string> TomlTable::optional_string(const std::string& key) const {
  record(key, {.form = KeyUse::Form::text});
  const TomlNode* value = read(key, false);
  if (!value) return std::nullopt;
  if (value->kind != Kind::string) {
    report_at(value->where, key, quoted(key) + " is " + kind_name(*value) + ", but a string is expected",
              "write it in quotes, as " + key + " = \"...\"");
    return std::nullopt;
  }
  if (value->text.empty()) {
    report_at(value->where, key, quoted(key) + " is an empty string", "fill it in, or remove the key");
    return std::nullopt;
  }
  return value->text;
}

std::string TomlTable::string(const std::string& key, const std::string& fallback) const {
  record(key, {.form = KeyUse::Form::text, .note = fallback});
  return optional_string(key).value_or(fallback);
}

bool TomlTable::boolean(const std::string& key) const {
  read(key, true);
  return boolean(key, false);
}

bool TomlTable::boolean(const std::string& key, bool fallback) const {
  record(key, {.form = KeyUse::Form::boolean, .note = fallback ? "true" : "false"});
  const TomlNode* value = read(key, false);
  if (!value) return fallback;
  if (value->kind == Kind::boolean) return value->boolean;
  report_at(value->where, key, quoted(key) + " is " + kind_name(*value) + ", but true or false is expected",
            "write " + key + " = true or " + key + " = false, without quotes");
  return fallback;
}

std::optional<std::int64_t> TomlTable::optional_integer(const std::string& key) const {
  record(key, {.form = KeyUse::Form::integer});
  const TomlNode* value = read(key, false);
  if (!value) return std::nullopt;
  if (value->kind == Kind::integer) return value->integer;
  report_at(value->where, key, quoted(key) + " is " + kind_name(*value) + ", but an integer is expected",
            "write a whole number without quotes, point or exponent, as " + whole_number(*value));
  return std::nullopt;
}

std::int64_t TomlTable::integer(const std::string& key) const {
  read(key, true);
  return optional_integer(key).value_or(0);
}

std::int64_t TomlTable::integer(const std::string& key, std::int64_t fallback) const {
  record(key, {.form = KeyUse::Form::integer, .note = std::to_string(fallback)});
  return optional_integer(key).value_or(fallback);
}

std::optional<double> TomlTable::number_of(const std::string& key, const TomlNode& value) const {
  if (value.kind != Kind::integer && value.kind != Kind::number) {
    report_at(value.where, key, quoted(key) + " is " + kind_name(value) + ", but a plain number is expected",
              "write a number without quotes and unit");
    return std::nullopt;
  }
  if (std::isfinite(value.number)) return value.number;
  report_at(value.where, key, quoted(key) + " is " + value.text + ", which is not a finite number",
            "give a finite number");
  return std::nullopt;
}

std::optional<double> TomlTable::optional_number(const std::string& key) const {
  record(key, {.form = KeyUse::Form::number});
  const TomlNode* value = read(key, false);
  return value ? number_of(key, *value) : std::nullopt;
}

double TomlTable::number(const std::string& key) const {
  read(key, true);
  return optional_number(key).value_or(0.0);
}

double TomlTable::number(const std::string& key, double fallback) const {
  record(key, {.form = KeyUse::Form::number, .note = number_text(fallback)});
  return optional_number(key).value_or(fallback);
}

std::optional<double> TomlTable::quantity_of(const std::string& key, const TomlNode& value,
                                             core::Dimension dimension) const {
  const bool bare = value.kind == Kind::integer || value.kind == Kind::number;
  if (bare && dimension == core::Dimension::dimensionless) return number_of(key, value);
  if (value.kind != Kind::string) {
    report_at(
        value.where, key,
        quoted(key) + " is " + kind_name(value) + ", but " + expected_quantity(dimension) + ", is expected",
        bare ? with_unit_hint(value.text, dimension)
             : "accepted units: " + core::list_of(core::units_of(dimension)));
    return std::nullopt;
  }
  try {
    return core::parse_quantity(value.text, dimension);
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      report_at(value.where, key, quoted(key) + ": " + problem.what, problem.hint);
    return std::nullopt;
  }
}

std::optional<double> TomlTable::optional_quantity(const std::string& key, core::Dimension dimension) const {
  record(key, {.form = KeyUse::Form::quantity, .dimension = dimension});
  const TomlNode* value = read(key, false);
  return value ? quantity_of(key, *value, dimension) : std::nullopt;
}

double TomlTable::quantity(const std::string& key, core::Dimension dimension, double fallback) const {
  record(key, {.form = KeyUse::Form::quantity,
               .dimension = dimension,
               .note = in_internal_unit(fallback, dimension)});
  return optional_quantity(key, dimension).value_or(fallback);
}

std::string TomlTable::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  if (read(key, true)) return choice(key, allowed, "");
  record(key, {.form = KeyUse::Form::text, .words = allowed});
  return allowed.front();
}

std::string TomlTable::choice(const std::string& key, const std::vector<std::string>& allowed,
                              const std::string& fallback) const {
  record(key, {.form = KeyUse::Form::text, .words = allowed, .note = fallback});
  const TomlNode* value = read(key, false);
  if (!value) return fallback;
  if (value->kind == Kind::string && std::find(allowed.begin(), allowed.end(), value->text) != allowed.end())
    return value->text;
  report_at(value->where, key,
            quoted(key) + " is " + kind_name(*value) + ", but one of " + core::list_quoted(allowed) +
                " is expected",
            did_you_mean(value->text, allowed) + "write one of these words in quotes");
  return allowed.front();
}

const TomlNode* TomlTable::array(const std::string& key, std::size_t count, bool required) const {
  const TomlNode* value = read(key, required);
  if (!value) return nullptr;
  const std::string wanted = count == 0 ? "an array" : "an array of " + std::to_string(count);
  if (value->kind != Kind::array) {
    report_at(value->where, key,
              quoted(key) + " is " + kind_name(*value) + ", but " + wanted + " is expected",
              "write the elements in brackets with commas between them: " + key + " = [..., ...]");
    return nullptr;
  }
  const std::size_t size = value->items.size();
  if ((count > 0 && size == count) || (count == 0 && size > 0)) return value;
  report_at(value->where, key,
            quoted(key) + " has " + std::to_string(size) + " elements, but " + wanted +
                (count == 0 ? " of one or more" : "") + " is expected",
            count == 0 ? "give at least one element" : "give exactly " + std::to_string(count));
  return nullptr;
}

std::vector<std::string> TomlTable::strings(const std::string& key, std::size_t count, bool required) const {
  record(key, {.form = KeyUse::Form::text, .list = true, .count = count});
  std::vector<std::string> result;
  const TomlNode* list = array(key, count, required);
  if (!list) return result;
  for (const TomlNode& item : list->items) {
    if (item.kind == Kind::string && !item.text.empty())
      result.push_back(item.text);
    else
      report_at(item.where, key,
                "an element of " + quoted(key) + " is " + kind_name(item) +
                    ", but a string that is not empty is expected",
                "write it in quotes");
  }
  return good(key) ? result : std::vector<std::string>{};
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count, bool required) const {
  record(key, {.form = KeyUse::Form::number, .list = true, .count = count});
  std::vector<double> result;
  const TomlNode* list = array(key, count, required);
  if (!list) return result;
  for (const TomlNode& item : list->items) result.push_back(number_of(key, item).value_or(0.0));
  return good(key) ? result : std::vector<double>{};
}

std::vector<double> TomlTable::quantities(const std::string& key, core::Dimension dimension,
                                          std::size_t count, bool required) const {
  record(key, {.form = KeyUse::Form::quantity, .dimension = dimension, .list = true, .count = count});
  std::vector<double> result;
  const TomlNode* list = array(key, count, required);
  if (!list) return result;
  for (const TomlNode& item : list->items) result.push_back(quantity_of(key, item, dimension).value_or(0.0));
  return good(key) ? result : std::vector<double>{};
}

std::optional<core::Vec3> TomlTable::optional_quantity3(const std::string& key,
                                                        core::Dimension dimension) const {
  const std::vector<double> values = quantities(key, dimension, 3, false);
  if (values.empty()) return std::nullopt;
  return core::Vec3(values[0], values[1], values[2]);
}

std::optional<core::Vec3> TomlTable::optional_number3(const std::string& key) const {
  const std::vector<double> values = numbers(key, 3, false);
  if (values.empty()) return std::nullopt;
  return core::Vec3(values[0], values[1], values[2]);
}

std::optional<core::Vec3> TomlTable::optional_direction(const std::string& key) const {
  const std::optional<core::Vec3> vector = optional_number3(key);
  if (!vector) return std::nullopt;
  const double length = vector->stableNorm();
  if (length > 0.0) return core::Vec3(*vector / length);
  report(key, quoted(key) + " is a direction of no length", "give a direction, as [0, 0, 1]");
  return std::nullopt;
}

std::filesystem::path TomlTable::existing_file(const std::string& key, bool required) const {
  record(key, {.form = KeyUse::Form::file});
  if (required && !read(key, true)) return {};
  const std::optional<std::string> name = optional_string(key);
  if (!name) return {};
  std::filesystem::path path(*name);
  if (path.is_relative()) path = std::filesystem::path(where(key).file).parent_path() / path;
  std::error_code status;
  if (std::filesystem::is_regular_file(path, status)) return path;
  report(
      key,
      quoted(key) + ": " +
          (std::filesystem::is_directory(path, status) ? "\"" + path.string() + "\" is a folder, not a file"
                                                       : "the file \"" + path.string() + "\" does not exist"),
      "check the name; a relative path counts from the folder of the file that names it");
  return {};
}

}  // namespace scintray::config
