#include "scintray/scene/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace scintray {

namespace {

using Kind = TomlNode::Kind;

std::string kind_name(const TomlNode& value) {
  switch (value.kind) {
    case Kind::string:
      return "the string \"" + value.text + "\"";
    case Kind::integer:
      return "the integer " + value.text;
    case Kind::number:
      return "the number " + value.text;
    case Kind::boolean:
      return "the boolean " + value.text;
    case Kind::date:
      return "the date or time " + value.text;
    case Kind::array:
      return "an array";
    case Kind::table:
      return "a table";
  }
  throw InternalError("unknown kind of TOML value");
}

std::string usual_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "mm";
    case Dimension::inverse_length:
      return "1/mm";
    case Dimension::wavelength:
      return "nm";
    case Dimension::time:
      return "ns";
    case Dimension::frequency:
      return "GHz";
    case Dimension::angle:
      return "deg";
    case Dimension::energy:
      return "keV";
    case Dimension::density:
      return "g/cm3";
    case Dimension::photons_per_energy:
      return "photons/MeV";
    case Dimension::dimensionless:
      return "";
  }
  throw InternalError("unknown dimension");
}

std::string expected_quantity(Dimension dimension) {
  if (dimension == Dimension::dimensionless) return "a number, or a string as \"97 %\"";
  const std::string name = dimension_name(dimension);
  return (name.find_first_of("aeiou") == 0 ? "an " : "a ") + name + " with its unit, as \"2 " +
         usual_unit(dimension) + "\"";
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string list_quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return text;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? "" : "did you mean \"" + near + "\"? ";
}

}  // namespace

/// What is shared by the tables opened from one outermost table.
struct TomlTable::Session {
  struct Marks {
    TomlNodePtr node;
    std::string path;
    bool absent = false;  ///< stands for a table that is missing: nothing more is said about it
    std::set<std::string> known, read, bad;
  };
  Problems* problems = nullptr;
  std::map<const TomlNode*, Marks> tables;

  Marks& of(const TomlNodePtr& node, const std::string& path) {
    Marks& marks = tables[node.get()];
    if (!marks.node) {
      marks.node = node;
      marks.path = path;
    }
    return marks;
  }
};

TomlTable::TomlTable(TomlNodePtr table, Problems& problems)
    : node_(std::move(table)), path_(node_->key), session_(std::make_shared<Session>()) {
  session_->problems = &problems;
  Session::Marks& marks = session_->of(node_, path_);
  if (node_->kind == Kind::table) return;
  problems.add(node_->where, "\"" + node_->key + "\" is " + kind_name(*node_) + ", but a table is expected",
               "write [" + node_->key + "] and its keys below, or { key = value, ... }");
  marks.absent = true;
}

TomlTable::TomlTable(TomlNodePtr node, std::string path, std::shared_ptr<Session> session)
    : node_(std::move(node)), path_(std::move(path)), session_(std::move(session)) {
  session_->of(node_, path_);
}

TomlTable TomlTable::child(const TomlNode& node, const std::string& key) const {
  return {TomlNodePtr(node_, &node), path_.empty() ? key : path_ + "." + key, session_};
}

FileLocation TomlTable::where(const std::string& key) const {
  const TomlNode* value = node_->find(key);
  return value ? value->where : node_->where;
}

bool TomlTable::has(const std::string& key) const {
  session_->of(node_, path_).known.insert(key);
  return node_->find(key) != nullptr;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  if (node_->kind == Kind::table)
    for (const TomlNode& member : node_->items) names.push_back(member.key);
  return names;
}

bool TomlTable::good(const std::string& key) const {
  const Session::Marks& marks = session_->of(node_, path_);
  return node_->find(key) && marks.read.count(key) > 0 && marks.bad.count(key) == 0;
}

std::string TomlTable::quoted(const std::string& key) const {
  return "\"" + (path_.empty() ? key : path_ + "." + key) + "\"";
}

void TomlTable::mark_bad(const std::string& key) const { session_->of(node_, path_).bad.insert(key); }

std::size_t TomlTable::problem_count() const { return session_->problems->list().size(); }

void TomlTable::report_at(const FileLocation& where, const std::string& key, std::string what,
                          std::string hint) const {
  mark_bad(key);
  session_->problems->add(where, std::move(what), std::move(hint));
}

void TomlTable::report(const std::string& key, std::string what, std::string hint) const {
  report_at(where(key), key, std::move(what), std::move(hint));
}

void TomlTable::expect(const std::string& key, bool ok, const std::string& what,
                       const std::string& hint) const {
  if (!ok && good(key)) report(key, what, hint);
}

std::optional<std::string> TomlTable::one_of(const std::vector<std::string>& choices, bool required) const {
  std::vector<std::string> found;
  for (const std::string& choice : choices)
    if (has(choice)) found.push_back(choice);
  const Session::Marks& marks = session_->of(node_, path_);
  if (found.empty()) {
    if (required && !marks.absent)
      session_->problems->add(node_->where,
                              (path_.empty() ? "the file" : "[" + path_ + "]") + " has none of " +
                                  list_quoted(choices) + ", and one of them is needed",
                              "add one of them");
    return std::nullopt;
  }
  for (std::size_t i = 1; i < found.size(); ++i) {
    const TomlNode* extra = node_->find(found[i]);
    session_->problems->add(extra->key_where,
                            quoted(found[i]) + " and \"" + found[0] + "\" are both given, but only one of " +
                                list_quoted(choices) + " may be",
                            "keep one of them");
    take(found[i]);
  }
  return found[0];
}

const TomlNode* TomlTable::read(const std::string& key, bool required) const {
  Session::Marks& marks = session_->of(node_, path_);
  marks.known.insert(key);
  const TomlNode* value = node_->find(key);
  if (value) marks.read.insert(key);
  if (!value && required && !marks.absent) {
    marks.bad.insert(key);
    session_->problems->add(
        node_->where,
        (path_.empty() ? "the file" : "[" + path_ + "]") + " has no \"" + key + "\", which is needed",
        "add " + key + " = ... there");
  }
  return value;
}

std::optional<std::string> TomlTable::optional_string(const std::string& key) const {
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

std::string TomlTable::string(const std::string& key) const {
  return read(key, true) ? optional_string(key).value_or("") : "";
}

std::string TomlTable::string(const std::string& key, const std::string& fallback) const {
  return optional_string(key).value_or(fallback);
}

bool TomlTable::boolean(const std::string& key) const {
  return read(key, true) ? boolean(key, false) : false;
}

bool TomlTable::boolean(const std::string& key, bool fallback) const {
  const TomlNode* value = read(key, false);
  if (!value) return fallback;
  if (value->kind == Kind::boolean) return value->boolean;
  report_at(value->where, key, quoted(key) + " is " + kind_name(*value) + ", but true or false is expected",
            "write " + key + " = true or " + key + " = false, without quotes");
  return fallback;
}

std::optional<std::int64_t> TomlTable::optional_integer(const std::string& key) const {
  const TomlNode* value = read(key, false);
  if (!value) return std::nullopt;
  if (value->kind == Kind::integer) return value->integer;
  report_at(value->where, key, quoted(key) + " is " + kind_name(*value) + ", but an integer is expected",
            "write a whole number without quotes, point or exponent, as 1_000_000");
  return std::nullopt;
}

std::int64_t TomlTable::integer(const std::string& key) const {
  return read(key, true) ? optional_integer(key).value_or(0) : 0;
}

std::int64_t TomlTable::integer(const std::string& key, std::int64_t fallback) const {
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
  const TomlNode* value = read(key, false);
  return value ? number_of(key, *value) : std::nullopt;
}

double TomlTable::number(const std::string& key) const {
  return read(key, true) ? optional_number(key).value_or(0.0) : 0.0;
}

double TomlTable::number(const std::string& key, double fallback) const {
  return optional_number(key).value_or(fallback);
}

std::optional<double> TomlTable::quantity_of(const std::string& key, const TomlNode& value,
                                             Dimension dimension) const {
  const bool bare = value.kind == Kind::integer || value.kind == Kind::number;
  if (bare && dimension == Dimension::dimensionless) return number_of(key, value);
  if (value.kind != Kind::string) {
    report_at(
        value.where, key,
        quoted(key) + " is " + kind_name(value) + ", but " + expected_quantity(dimension) + ", is expected",
        bare ? "write it as a string with its unit, as \"" + value.text + " " + usual_unit(dimension) + "\""
             : "accepted units: " + list_of(units_of(dimension)));
    return std::nullopt;
  }
  try {
    return parse_quantity(value.text, dimension);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems())
      report_at(value.where, key, quoted(key) + ": " + problem.what, problem.hint);
    return std::nullopt;
  }
}

std::optional<double> TomlTable::optional_quantity(const std::string& key, Dimension dimension) const {
  const TomlNode* value = read(key, false);
  return value ? quantity_of(key, *value, dimension) : std::nullopt;
}

double TomlTable::quantity(const std::string& key, Dimension dimension) const {
  return read(key, true) ? optional_quantity(key, dimension).value_or(0.0) : 0.0;
}

double TomlTable::quantity(const std::string& key, Dimension dimension, double fallback) const {
  return optional_quantity(key, dimension).value_or(fallback);
}

std::string TomlTable::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  return read(key, true) ? choice(key, allowed, allowed.front()) : allowed.front();
}

std::string TomlTable::choice(const std::string& key, const std::vector<std::string>& allowed,
                              const std::string& fallback) const {
  const TomlNode* value = read(key, false);
  if (!value) return fallback;
  if (value->kind == Kind::string && std::find(allowed.begin(), allowed.end(), value->text) != allowed.end())
    return value->text;
  report_at(
      value->where, key,
      quoted(key) + " is " + kind_name(*value) + ", but one of " + list_quoted(allowed) + " is expected",
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
              "write the elements in brackets, with commas");
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
  std::vector<double> result;
  const TomlNode* list = array(key, count, required);
  if (!list) return result;
  for (const TomlNode& item : list->items) result.push_back(number_of(key, item).value_or(0.0));
  return good(key) ? result : std::vector<double>{};
}

std::vector<double> TomlTable::quantities(const std::string& key, Dimension dimension, std::size_t count,
                                          bool required) const {
  std::vector<double> result;
  const TomlNode* list = array(key, count, required);
  if (!list) return result;
  for (const TomlNode& item : list->items) result.push_back(quantity_of(key, item, dimension).value_or(0.0));
  return good(key) ? result : std::vector<double>{};
}

std::optional<Vec3> TomlTable::optional_quantity3(const std::string& key, Dimension dimension) const {
  const std::vector<double> values = quantities(key, dimension, 3, false);
  if (values.empty()) return std::nullopt;
  return Vec3(values[0], values[1], values[2]);
}

std::optional<Vec3> TomlTable::optional_number3(const std::string& key) const {
  const std::vector<double> values = numbers(key, 3, false);
  if (values.empty()) return std::nullopt;
  return Vec3(values[0], values[1], values[2]);
}

std::optional<Vec3> TomlTable::optional_direction(const std::string& key) const {
  const std::optional<Vec3> vector = optional_number3(key);
  if (!vector) return std::nullopt;
  const double length = vector->stableNorm();
  if (length > 0.0) return Vec3(*vector / length);
  report(key, quoted(key) + " is a direction of no length", "give a direction, as [0, 0, 1]");
  return std::nullopt;
}

std::filesystem::path TomlTable::existing_file(const std::string& key, bool required) const {
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

TomlTable TomlTable::table(const std::string& key) const {
  if (read(key, true)) {
    const std::optional<TomlTable> found = optional_table(key);
    if (found) return *found;
  }
  auto absent = std::make_shared<TomlNode>();
  absent->key = key;
  absent->where = absent->key_where = where(key);
  TomlTable result(absent, path_.empty() ? key : path_ + "." + key, session_);
  session_->of(absent, result.path_).absent = true;
  return result;
}

std::optional<TomlTable> TomlTable::optional_table(const std::string& key) const {
  const TomlNode* value = read(key, false);
  if (!value) return std::nullopt;
  if (value->kind == Kind::table) return child(*value, key);
  const bool list =
      value->kind == Kind::array && !value->items.empty() && value->items[0].kind == Kind::table;
  report_at(
      value->where, key,
      quoted(key) + " is " + (list ? "a list of tables" : kind_name(*value)) + ", but a table is expected",
      list ? "write it once, as [" + key + "]"
           : "write [" + key + "] and its keys below, or " + key + " = { ... }");
  return std::nullopt;
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  std::vector<TomlTable> result;
  const TomlNode* value = read(key, false);
  if (!value) return result;
  const std::string full = path_.empty() ? key : path_ + "." + key;
  if (value->kind != Kind::array) {
    report_at(value->where, key,
              quoted(key) + " is " + kind_name(*value) + ", but a list of tables is expected",
              "write [[" + full + "]], in two pairs of brackets, for every one");
    return result;
  }
  for (const TomlNode& item : value->items) {
    if (item.kind == Kind::table)
      result.push_back(child(item, key));
    else
      report_at(item.where, key,
                "an element of " + quoted(key) + " is " + kind_name(item) + ", but a table is expected",
                "write [[" + full + "]], in two pairs of brackets, for every one");
  }
  return result;
}

std::vector<TomlTable> TomlTable::named_tables(const std::string& key) const {
  std::vector<TomlTable> result;
  const std::optional<TomlTable> outer = optional_table(key);
  if (!outer) return result;
  for (const std::string& name : outer->keys())
    if (const std::optional<TomlTable> inner = outer->optional_table(name)) result.push_back(*inner);
  return result;
}

TomlNodePtr TomlTable::take(const std::string& key) const {
  const TomlNode* value = read(key, false);
  return value ? TomlNodePtr(node_, value) : nullptr;
}

void TomlTable::skip() const {
  for (const std::string& key : keys()) session_->of(node_, path_).read.insert(key);
}

void TomlTable::finish() const {
  std::vector<Problem> found;
  for (const auto& [node, marks] : session_->tables) {
    if (node->kind != Kind::table) continue;
    const std::vector<std::string> known(marks.known.begin(), marks.known.end());
    const std::string place = marks.path.empty() ? "at the top of the file" : "in [" + marks.path + "]";
    for (const TomlNode& member : node->items) {
      if (marks.read.count(member.key) > 0) continue;
      if (marks.known.count(member.key) > 0)
        found.push_back({member.key_where,
                         "\"" + member.key + "\" " + place + " has no meaning beside the other keys there",
                         "remove it"});
      else
        found.push_back({member.key_where, "unknown key \"" + member.key + "\" " + place,
                         did_you_mean(member.key, known) + "known keys here: " + list_of(known)});
    }
  }
  const auto order = [](const Problem& p) { return std::tie(p.where.line, p.where.column); };
  std::sort(found.begin(), found.end(),
            [&](const Problem& a, const Problem& b) { return order(a) < order(b); });
  for (Problem& problem : found) session_->problems->add(std::move(problem));
}

std::vector<std::string> TomlTable::known_keys() const {
  std::set<std::string> all;
  for (const auto& [node, marks] : session_->tables)
    for (const std::string& key : marks.known) all.insert(marks.path.empty() ? key : marks.path + "." + key);
  return {all.begin(), all.end()};
}

}  // namespace scintray
