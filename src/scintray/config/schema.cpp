#include "scintray/config/schema.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <set>
#include <utility>

#include "scintray/config/detail/toml_words.hpp"

namespace scintray::config {

namespace {

using Form = KeyUse::Form;
using Kind = TomlNode::Kind;

constexpr const char* kAbsent = "";
constexpr std::size_t kMostSettings = 5;  // values besides the usual ones in one document

/// What a document has at each key in place of the usual sample: a sample's label, or kAbsent.
using Settings = std::map<std::string, std::string>;

std::string key_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

TomlNode scalar(Kind kind, std::string text, double number = 0.0) {
  TomlNode node;
  node.kind = kind;
  node.text = std::move(text);
  node.number = number;
  node.integer = static_cast<std::int64_t>(number);
  node.boolean = node.text == "true";
  return node;
}

constexpr const char* kSampleText = "sample";

/// True for a message about the samples of this file.
bool of_a_sample(const std::string& rule) {
  return rule.find(kSampleText) != std::string::npos || rule.find("\"\"") != std::string::npos ||
         rule.find(" 1 mm") != std::string::npos || rule.ends_with(" is 0") || rule.ends_with(" is 1") ||
         rule.ends_with(" is 1000") || rule.ends_with(" 1");
}

/// A value that a form accepts, but for tables.
TomlNode sample(const KeyUse& use) {
  TomlNode one;
  if (use.form == Form::boolean)
    one = scalar(Kind::boolean, "true");
  else if (use.form == Form::integer || use.form == Form::number)
    one = scalar(Kind::integer, "1", 1.0);
  else if (use.form == Form::quantity || use.form == Form::curve)
    one = usual_unit(use.dimension).empty() ? scalar(Kind::integer, "1", 1.0)
                                            : scalar(Kind::string, "1 " + usual_unit(use.dimension));
  else
    one = scalar(Kind::string, use.words.empty() ? kSampleText : use.words.front());
  if (!use.list) return one;
  TomlNode list;
  list.kind = Kind::array;
  for (std::size_t i = 0; i < std::max<std::size_t>(use.count, 1); ++i) list.items.push_back(one);
  return list;
}

/// The uses of one key by a reader, and the samples of it that a document may contain.
struct Known {
  std::string table, key;
  Settings beside;  ///< of the first document in which it was used
  std::vector<KeyUse> forms;
  std::vector<std::string> rules;
  std::string fallback;
  std::size_t required = 0;  ///< readings in which it was required
  std::size_t last_reading = 0;
  std::size_t last_use = 0;                 ///< reading in which it was used last
  bool lost = false;                        ///< no longer used beside keys that were found after it
  std::map<std::string, TomlNode> samples;  ///< by label
  std::vector<std::string> labels;          ///< in the order of discovery

  bool of_no_form() const {
    return std::all_of(forms.begin(), forms.end(),
                       [](const KeyUse& use) { return use.form == Form::present || use.form == Form::raw; });
  }
  void add_sample(const std::string& label, TomlNode node) {
    if (samples.emplace(label, std::move(node)).second) labels.push_back(label);
  }
};

struct Group {
  std::vector<std::string> keys;
  std::size_t needed = 0;  ///< readings in which one of them was required
  std::size_t seen = 0;    ///< readings in which it was read
  std::size_t last_reading = 0;
};

struct Table {
  std::vector<std::string> keys;  ///< full paths, in the order of reading
  std::vector<Group> groups;
  std::size_t readings = 0;  ///< documents in which it was read
};

class Explorer {
 public:
  Explorer(const DocumentReader& reader, const std::string& root) : reader_(reader), root_(root) {}

  void explore() {
    std::deque<Settings> waiting{{}};
    std::set<Settings> seen{{}};
    while (!waiting.empty()) {
      const Settings settings = waiting.front();
      waiting.pop_front();
      const std::vector<std::string> found = read_all(settings);
      for (const std::string& path : found)
        for (Settings& next : alternatives(path, settings))
          if (next.size() <= kMostSettings && seen.insert(next).second) waiting.push_back(std::move(next));
    }
  }

  std::vector<TableSchema> result() const {
    std::vector<TableSchema> schema;
    for (const std::string& path : table_order_) {
      const Table& table = tables_.at(path);
      TableSchema one{path, {}, {}, {}};
      for (const std::string& full : table.keys) {
        const Known& known = known_.at(full);
        KeySchema key{known.key, {}, known.rules, known.fallback, known.required == table.readings, {}};
        for (const KeyUse& use : known.forms)
          if (known.of_no_form() ? use.form == Form::raw : use.form != Form::present && use.form != Form::raw)
            key.forms.push_back(use);
        for (const auto& [at, label] : known.beside)
          key.beside.push_back(label == kAbsent ? "without " + at : at + label);
        one.keys.push_back(std::move(key));
      }
      for (const Group& group : table.groups) {
        if (group.seen < table.readings) continue;
        one.one_of.push_back(group.keys);
        one.one_needed.push_back(group.needed == table.readings);
      }
      schema.push_back(std::move(one));
    }
    return schema;
  }

 private:
  /// Reads documents with these settings until nothing new is found; paths of what is new.
  std::vector<std::string> read_all(const Settings& settings) {
    std::vector<std::string> found;
    for (bool more = true; more;) {
      more = false;
      const auto document = std::make_shared<TomlNode>(table_node(root_, settings));
      ++reading_;
      std::set<std::string> read_tables;
      for (const KeyUse& use : reader_(document)) {
        if (read_tables.insert(use.table).second) ++table_at(use.table).readings;
        const std::string path = key_path(use.table, use.key);
        const bool is_new = add(use, settings);
        if (use.form != Form::one_of) note_use(known_.at(path), use);
        if (!is_new) continue;
        more = true;
        if (std::find(found.begin(), found.end(), path) == found.end()) found.push_back(path);
      }
    }
    find_lost(settings, found);
    return found;
  }

  /// Testing whether a key with a value is present is no use of it.
  void note_use(Known& known, const KeyUse& use) const {
    if (use.form != Form::present || known.of_no_form()) known.last_use = reading_;
  }

  /// Keys of these settings that the last document of them did not use, and keys lost before that it did use:
  /// those are read beside these settings.
  void find_lost(const Settings& settings, std::vector<std::string>& found) {
    for (auto& [path, known] : known_) {
      const bool used = known.last_use == reading_;
      if (used && known.lost) {
        known.lost = false;
        known.beside = settings;
        if (std::find(found.begin(), found.end(), path) == found.end()) found.push_back(path);
      } else if (!used && known.beside == settings) {
        known.lost = true;
      }
    }
  }

  Table& table_at(const std::string& path) {
    if (tables_.count(path) == 0) table_order_.push_back(path);
    return tables_[path];
  }

  /// True when the use may change the documents.
  bool add(const KeyUse& use, const Settings& settings) {
    if (use.form == Form::one_of) return add_group(use);
    const std::string path = key_path(use.table, use.key);
    const auto [at, is_new] = known_.try_emplace(path);
    Known& known = at->second;
    if (is_new) {
      known.table = use.table;
      known.key = use.key;
      known.beside = settings;
      table_at(use.table).keys.push_back(path);
    }
    if (use.form == Form::rule) {
      const std::string rule = use.note.substr(0, use.note.find(", but "));
      if (!of_a_sample(rule) && std::find(known.rules.begin(), known.rules.end(), rule) == known.rules.end())
        known.rules.push_back(rule);
      return is_new;
    }
    if (use.required && known.last_reading != reading_) {
      known.last_reading = reading_;
      ++known.required;
    }
    if (!use.note.empty()) known.fallback = use.note;
    KeyUse form = use;
    form.note.clear();
    form.required = false;
    if (std::find(known.forms.begin(), known.forms.end(), form) != known.forms.end()) return is_new;
    known.forms.push_back(form);
    add_samples(known, form);
    return true;
  }

  bool add_group(const KeyUse& use) {
    Table& table = table_at(use.table);
    auto group = std::find_if(table.groups.begin(), table.groups.end(),
                              [&](const Group& one) { return one.keys == use.words; });
    const bool is_new = group == table.groups.end();
    if (is_new) group = table.groups.insert(table.groups.end(), {use.words});
    if (std::exchange(group->last_reading, reading_) == reading_) return is_new;
    ++group->seen;
    if (use.required) ++group->needed;
    return is_new;
  }

  static void add_samples(Known& known, const KeyUse& use) {
    if (use.form == Form::table || use.form == Form::tables) {
      known.add_sample(use.form == Form::table ? " as a table" : " as a list of tables", {});
    } else if (use.form == Form::boolean) {
      known.add_sample(" = true", scalar(Kind::boolean, "true"));
      known.add_sample(" = false", scalar(Kind::boolean, "false"));
    } else if (use.form == Form::present || use.form == Form::raw) {
      known.add_sample(" as text", scalar(Kind::string, kSampleText));
      known.add_sample(" as a number", scalar(Kind::integer, "1", 1.0));
      known.add_sample(" as a table", {});
      TomlNode list;
      list.kind = Kind::array;
      list.items.push_back(scalar(Kind::string, kSampleText));
      known.add_sample(" as a list", std::move(list));
    } else if (!use.words.empty() && !use.list) {
      for (const std::string& word : use.words)
        known.add_sample(" = \"" + word + "\"", scalar(Kind::string, word));
    } else {
      const char* label = use.list                                           ? " as a list"
                          : use.form == Form::text || use.form == Form::file ? " as text"
                                                                             : " as a value";
      known.add_sample(label, sample(use));
    }
  }

  /// The usual sample of a key: of the first form with a value, absent for the later keys of a group.
  std::string usual(const std::string& path) const {
    const Known& known = known_.at(path);
    for (const Group& group : tables_.at(known.table).groups)
      for (std::size_t i = 1; i < group.keys.size(); ++i)
        if (group.keys[i] == known.key) return kAbsent;
    for (const KeyUse& use : known.forms) {
      if (use.form == Form::present || use.form == Form::raw) continue;
      Known alone;
      add_samples(alone, use);
      return alone.labels.front();
    }
    return known.labels.empty() ? kAbsent : known.labels.front();
  }

  /// The settings under which something new was found at a key, with each other value there.
  std::vector<Settings> alternatives(const std::string& path, const Settings& base) const {
    std::vector<Settings> list;
    const auto found = known_.find(path);
    if (found == known_.end()) return list;  // a group, whose keys are known on their own
    std::vector<std::string> labels = found->second.labels;
    labels.push_back(kAbsent);
    for (const std::string& label : labels) {
      if (label == usual(path)) continue;
      Settings settings = base;
      settings[path] = label;
      list.push_back(std::move(settings));
    }
    return list;
  }

  /// What a document has at a key; nothing when it is absent.
  std::optional<std::string> label_at(const std::string& path, const Settings& settings) const {
    const Known& known = known_.at(path);
    const auto set = settings.find(path);
    if (set != settings.end())
      return set->second == kAbsent ? std::nullopt : std::optional<std::string>(set->second);
    for (const auto& [at, label] : known.beside) {
      const auto here = settings.find(at);
      if (here == settings.end() || here->second != label) return std::nullopt;
    }
    // A key of a group is absent where another of the group is set.
    for (const Group& group : tables_.at(known.table).groups) {
      if (std::find(group.keys.begin(), group.keys.end(), known.key) == group.keys.end()) continue;
      for (const std::string& other : group.keys) {
        const auto one = settings.find(key_path(known.table, other));
        if (one != settings.end() && one->second != kAbsent) return std::nullopt;
      }
    }
    const std::string label = usual(path);
    return label == kAbsent ? std::nullopt : std::optional<std::string>(label);
  }

  TomlNode table_node(const std::string& path, const Settings& settings) const {
    TomlNode node;
    node.where = node.key_where = {"sample.toml", 1, 1};
    const auto table = tables_.find(path);
    if (table == tables_.end()) return node;
    for (const std::string& full : table->second.keys) {
      const Known& known = known_.at(full);
      const std::optional<std::string> label = label_at(full, settings);
      if (!label) continue;
      TomlNode value;
      if (*label == " as a table") {
        value = table_node(full, settings);
      } else if (*label == " as a list of tables") {
        value.kind = Kind::array;
        value.items.push_back(table_node(full, settings));
      } else if (known.samples.count(*label) > 0) {
        value = known.samples.at(*label);
      }
      value.key = known.key;
      value.where = value.key_where = node.where;
      for (TomlNode& item : value.items) item.where = item.key_where = node.where;
      node.items.push_back(std::move(value));
    }
    return node;
  }

  const DocumentReader& reader_;
  std::string root_;
  std::map<std::string, Known> known_;
  std::map<std::string, Table> tables_;
  std::vector<std::string> table_order_;
  std::size_t reading_ = 0;
};

}  // namespace

std::vector<TableSchema> explore_keys(const DocumentReader& reader, const std::string& root) {
  Explorer explorer(reader, root);
  explorer.explore();
  return explorer.result();
}

}  // namespace scintray::config
