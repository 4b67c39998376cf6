#include "scintray/config/toml_reader.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "scintray/config/detail/toml_words.hpp"

namespace scintray::config {

namespace {

using Kind = TomlNode::Kind;

std::string missing_text(const std::string& table, const std::string& key) {
  return (table.empty() ? "the file" : "[" + table + "]") + " has no \"" + key + "\", which is needed";
}

}  // namespace

/// State shared by the tables opened from one outermost table.
struct TomlTable::Session {
  struct Marks {
    TomlNodePtr node;
    std::string path;
    bool absent = false;  ///< represents a missing table, for which no further problem is reported
    std::set<std::string> known, read, bad;
  };
  core::Problems* problems = nullptr;
  bool recording = false;
  std::vector<KeyUse> uses;
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

TomlTable::TomlTable(TomlNodePtr table, core::Problems& problems, std::optional<std::string> path)
    : node_(std::move(table)), path_(path.value_or(node_->key)), session_(std::make_shared<Session>()) {
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

core::FileLocation TomlTable::where(const std::string& key) const {
  const TomlNode* value = node_->find(key);
  return value ? value->where : node_->where;
}

void TomlTable::record_uses() const { session_->recording = true; }

const std::vector<KeyUse>& TomlTable::key_uses() const { return session_->uses; }

void TomlTable::record(const std::string& key, KeyUse use) const {
  if (!session_->recording) return;
  use.table = path_;
  use.key = key;
  session_->uses.push_back(std::move(use));
}

bool TomlTable::has(const std::string& key) const {
  record(key, {.form = KeyUse::Form::present});
  session_->of(node_, path_).known.insert(key);
  return node_->find(key) != nullptr;
}

bool TomlTable::is_array(const std::string& key) const {
  record(key, {.form = KeyUse::Form::raw});
  const TomlNode* value = node_->find(key);
  return value && value->kind == Kind::array;
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

void TomlTable::report_at(const core::FileLocation& where, const std::string& key, std::string what,
                          std::string hint) const {
  mark_bad(key);
  session_->problems->add(where, std::move(what), std::move(hint));
}

void TomlTable::report(const std::string& key, std::string what, std::string hint) const {
  report_at(where(key), key, std::move(what), std::move(hint));
}

void TomlTable::expect(const std::string& key, bool ok, const std::string& what,
                       const std::string& hint) const {
  record(key, {.form = KeyUse::Form::rule, .note = what});
  if (!ok && good(key)) report(key, what, hint);
}

std::optional<std::string> TomlTable::one_of(const std::vector<std::string>& choices, bool required) const {
  record("", {.form = KeyUse::Form::one_of, .words = choices, .required = required});
  std::vector<std::string> found;
  for (const std::string& choice : choices)
    if (has(choice)) found.push_back(choice);
  Session::Marks& marks = session_->of(node_, path_);
  if (found.empty()) {
    if (required && !marks.absent) {
      marks.bad.insert(choices.begin(), choices.end());
      session_->problems->add(node_->where,
                              (path_.empty() ? "the file" : "[" + path_ + "]") + " has none of " +
                                  core::list_quoted(choices) + ", and one of them is needed",
                              "add one of them");
    }
    return std::nullopt;
  }
  for (std::size_t i = 1; i < found.size(); ++i) {
    const TomlNode* extra = node_->find(found[i]);
    session_->problems->add(extra->key_where,
                            quoted(found[i]) + " and \"" + found[0] + "\" are both given, but only one of " +
                                core::list_quoted(choices) + " may be",
                            "keep one of them");
    take(found[i]);
  }
  return found[0];
}

const TomlNode* TomlTable::read(const std::string& key, bool required) const {
  Session::Marks& marks = session_->of(node_, path_);
  marks.known.insert(key);
  if (required) record(key, {.form = KeyUse::Form::present, .required = true});
  const TomlNode* value = node_->find(key);
  if (value) marks.read.insert(key);
  if (!value && required && !marks.absent) {
    marks.bad.insert(key);
    session_->problems->add(node_->where, missing_text(path_, key), "add " + key + " = ... there");
  }
  return value;
}

// The hint for a missing required key has the form of its value, where the type is known.

double TomlTable::quantity(const std::string& key, core::Dimension dimension) const {
  if (!node_->find(key) && !session_->of(node_, path_).absent) {
    const std::string value = dimension == core::Dimension::dimensionless ? " = ..." : " = \"...\"";
    session_->of(node_, path_).bad.insert(key);
    session_->problems->add(node_->where, missing_text(path_, key),
                            "add " + key + value + " there: " + expected_quantity(dimension));
    record(key, {.form = KeyUse::Form::present, .required = true});
  } else {
    read(key, true);
  }
  return optional_quantity(key, dimension).value_or(0.0);
}

std::string TomlTable::string(const std::string& key) const {
  if (!node_->find(key) && !session_->of(node_, path_).absent) {
    session_->of(node_, path_).bad.insert(key);
    session_->problems->add(node_->where, missing_text(path_, key), "add " + key + " = \"...\" there");
    record(key, {.form = KeyUse::Form::present, .required = true});
  } else {
    read(key, true);
  }
  return optional_string(key).value_or("");
}

TomlTable TomlTable::table(const std::string& key) const {
  if (read(key, true)) {
    const std::optional<TomlTable> found = optional_table(key);
    if (found) return *found;
  }
  record(key, {.form = KeyUse::Form::table});
  auto absent = std::make_shared<TomlNode>();
  absent->key = key;
  absent->where = absent->key_where = where(key);
  TomlTable result(absent, path_.empty() ? key : path_ + "." + key, session_);
  session_->of(absent, result.path_).absent = true;
  return result;
}

std::optional<TomlTable> TomlTable::optional_table(const std::string& key) const {
  record(key, {.form = KeyUse::Form::table});
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
  record(key, {.form = KeyUse::Form::tables});
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
  record(key, {.form = KeyUse::Form::raw});
  const TomlNode* value = read(key, false);
  return value ? TomlNodePtr(node_, value) : nullptr;
}

void TomlTable::skip() const {
  for (const std::string& key : keys()) session_->of(node_, path_).read.insert(key);
}

std::string TomlTable::hint_for_unknown(const TomlNode& table, const std::string& key) const {
  const Session::Marks& here = session_->tables.at(&table);
  const auto within = [](const std::string& path, const std::string& outer) {
    return outer.empty() || path.rfind(outer + ".", 0) == 0;
  };
  // The innermost table around this one where the key is known; else the only other table where it is.
  const Session::Marks* around = nullptr;
  std::map<std::string, const Session::Marks*> elsewhere;
  for (const auto& [node, marks] : session_->tables) {
    if (marks.known.count(key) == 0 || marks.path == here.path) continue;
    elsewhere.emplace(marks.path, &marks);
    if (within(here.path, marks.path) && (!around || marks.path.size() > around->path.size()))
      around = &marks;
  }
  const auto header = [](const Session::Marks& marks) {
    return marks.path.empty()        ? std::string("the top of the file")
           : marks.node->key.empty() ? "[[" + marks.path + "]]"
                                     : "[" + marks.path + "]";
  };
  const std::vector<std::string> known(here.known.begin(), here.known.end());
  const std::string list = "known keys here: " + core::list_of(known);
  if (around && table.header)
    return "it belongs to " + header(*around) + ", but all keys below the line " + header(here) + " (line " +
           std::to_string(table.where.line) + ") are that table's: move it above that line; " + list;
  if (around)
    return "it belongs to " + header(*around) + ": write it outside of the { ... } of " + header(here) +
           "; " + list;
  const std::string near = did_you_mean(key, known);
  if (near.empty() && elsewhere.size() == 1)
    return "it belongs to " + header(*elsewhere.begin()->second) + "; " + list;
  return near + list;
}

void TomlTable::finish() const {
  std::vector<core::Problem> found;
  for (const auto& [node, marks] : session_->tables) {
    if (node->kind != Kind::table) continue;
    const std::string place = marks.path.empty() ? "at the top of the file" : "in [" + marks.path + "]";
    for (const TomlNode& member : node->items) {
      if (marks.read.count(member.key) > 0) continue;
      const bool known = marks.known.count(member.key) > 0;
      if (known && marks.bad.empty())
        found.push_back({member.key_where,
                         "\"" + member.key + "\" " + place + " has no meaning beside the other keys there",
                         "remove it"});
      if (!known)
        found.push_back({member.key_where, "unknown key \"" + member.key + "\" " + place,
                         hint_for_unknown(*node, member.key)});
    }
  }
  const auto order = [](const core::Problem& p) { return std::tie(p.where.line, p.where.column); };
  std::sort(found.begin(), found.end(),
            [&](const core::Problem& a, const core::Problem& b) { return order(a) < order(b); });
  for (core::Problem& problem : found) session_->problems->add(std::move(problem));
}

std::vector<std::string> TomlTable::known_keys() const {
  std::set<std::string> all;
  for (const auto& [node, marks] : session_->tables)
    for (const std::string& key : marks.known) all.insert(marks.path.empty() ? key : marks.path + "." + key);
  return {all.begin(), all.end()};
}

}  // namespace scintray::config
