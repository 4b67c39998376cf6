#include "scintray/scene_file/sweep.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "scintray/core/text.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

/// Keys of the run as a whole, which cannot differ between the points of one results file.
const std::set<std::string> kFixedKeys{"title", "run.output", "run.threads"};

/// Tables of the use of a scene, which are not part of the scene itself.
const std::set<std::string> kFixedTables{"sweep", "fit"};

std::vector<std::string> segments_of(const std::string& path) {
  std::vector<std::string> segments;
  std::string segment;
  std::istringstream stream(path);
  while (std::getline(stream, segment, '.')) segments.push_back(segment);
  if (path.empty() || path.back() == '.') segments.emplace_back();
  return segments;
}

/// Arrays of tables whose entries are identified by a key other than `name`.
constexpr core::Word<const char*> kNameKeys[] = {{"mixture", "surface"}};

/// Name of an entry of an array of tables in a path.
std::string name_of(const config::TomlNode& array, const config::TomlNode& entry) {
  const config::TomlNode* name = entry.find(core::find_word(kNameKeys, array.key).value_or("name"));
  return name && name->kind == Kind::string ? name->text : "";
}

/// Keys that can follow a node in a path.
std::vector<std::string> continuations(const config::TomlNode& node) {
  std::vector<std::string> names;
  if (node.kind != Kind::table && node.kind != Kind::array) return names;
  for (const config::TomlNode& item : node.items) {
    const std::string name = node.kind == Kind::table ? item.key : name_of(node, item);
    if (!name.empty()) names.push_back(name);
  }
  return names;
}

std::optional<std::size_t> coordinate(const config::TomlNode& node, const std::string& segment) {
  static const std::vector<std::string> names{"x", "y", "z"};
  const auto found = std::find(names.begin(), names.end(), segment);
  if (node.kind != Kind::array || node.items.size() != 3 || found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

config::TomlNode* step_into(config::TomlNode& node, const std::string& segment) {
  if (node.kind == Kind::table) return node.find(segment);
  if (const auto index = coordinate(node, segment)) return &node.items[*index];
  if (node.kind != Kind::array) return nullptr;
  for (config::TomlNode& entry : node.items)
    if (!segment.empty() && name_of(node, entry) == segment) return &entry;
  return nullptr;
}

void report_dead_end(const KeyPath& path, const std::string& so_far, const std::string& segment,
                     const config::TomlNode& node, core::Problems& problems) {
  const std::vector<std::string> names = continuations(node);
  const std::string near = core::nearest_word(segment, names);
  problems.add(
      path.where,
      "the " + path.role + " \"" + path.key + "\" leads nowhere: " +
          (so_far.empty() ? "the scene" : "\"" + so_far + "\"") + " has no \"" + segment + "\"",
      (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
          (names.empty() ? "nothing can follow there" : "what can follow there: " + core::list_of(names)));
}

std::string millimetres(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return std::string(digits.data(), end) + " mm";
}

/// Moves [low, high] so that its centre is `value`; errors are left to the reader of the slab.
void move_slab(config::TomlNode& slab, const KeySetting& setting, core::Problems& problems) {
  const config::TomlNode& value = setting.value;
  std::array<double, 3> mm{};
  const std::array<const config::TomlNode*, 3> nodes{&slab.items[0], &slab.items[1], &value};
  for (std::size_t i = 0; i < 3; ++i) {
    try {
      if (nodes[i]->kind != Kind::string)
        throw core::InputError({{},
                                nodes[i]->as_written() + " has no unit, but a length is expected",
                                "write it as a string with its unit, as \"2 mm\""});
      mm[i] = core::parse_quantity(nodes[i]->text, core::Dimension::length);
    } catch (const core::InputError& error) {
      if (i < 2) return;
      for (const core::Problem& problem : error.problems())
        problems.add(value.where,
                     "a value of the " + setting.path.role + " \"" + setting.path.key + "\": " + problem.what,
                     problem.hint);
      return;
    }
  }
  const double half = 0.5 * (mm[1] - mm[0]);
  const std::array<double, 2> ends{mm[2] - half, mm[2] + half};
  for (std::size_t i = 0; i < 2; ++i) {
    slab.items[i].text = millimetres(ends[i]);
    slab.items[i].where = slab.items[i].key_where = value.where;
  }
}

std::optional<SweepSpec> read_sweep(const config::TomlTable& table) {
  SweepSpec sweep;
  KeyPath& path = sweep.path;
  path.key = table.string("key");
  path.where = table.where("key");
  sweep.label = table.string("label", path.key);
  const config::TomlNodePtr values = table.take("values");
  if (!values) {
    table.report("values", "[sweep] has no \"values\", which is needed", "add values = [ ... ] there");
    return std::nullopt;
  }
  if (values->kind != Kind::array || values->items.empty()) {
    table.report("values", "\"sweep.values\" is not an array of one value or more",
                 "write values = [\"2 mm\", \"6 mm\"]");
    return std::nullopt;
  }
  sweep.values = values->items;
  path.also = table.strings("also", 0, false);
  table.expect("key", may_be_set(path.key),
               "\"" + path.key + "\" is the same for a whole run and cannot be swept",
               "sweep a key of the scene, or make one scene file for each value");
  if (!table.good("key")) return std::nullopt;
  return sweep;
}

}  // namespace

bool may_be_set(const std::string& key) {
  return kFixedKeys.count(key) == 0 && kFixedTables.count(segments_of(key).front()) == 0;
}

std::vector<SweepSpec> read_sweeps(const config::TomlTable& scene) {
  /// Largest accepted number of points: the results of more would not fit in memory.
  constexpr std::size_t kMostPoints = 100000;
  std::vector<SweepSpec> sweeps;
  std::set<std::string> keys;
  std::size_t points = 1;
  for (const config::TomlTable& table : scene.tables("sweep")) {
    const std::optional<SweepSpec> sweep = read_sweep(table);
    if (!sweep) continue;
    std::vector<std::string> swept = sweep->path.also;
    swept.push_back(sweep->path.key);
    for (const std::string& key : swept)
      table.expect(key == sweep->path.key ? "key" : "also", keys.insert(key).second,
                   "\"" + key + "\" is swept twice", "put all its values into one [[sweep]]");
    table.expect("key", sweep->values.size() <= kMostPoints / points,
                 "the sweeps together have more than " + std::to_string(kMostPoints) + " points",
                 "several sweeps multiply: give fewer values");
    if (!table.good("key")) continue;
    points *= sweep->values.size();
    sweeps.push_back(*sweep);
  }
  return sweeps;
}

namespace {

/// The same for the first key alone.
config::TomlNode with_one_value(const config::TomlNode& document, const KeySetting& setting,
                                core::Problems& problems) {
  const KeyPath& path = setting.path;
  config::TomlNode edited = document;
  const std::vector<std::string> segments = segments_of(path.key);
  config::TomlNode* node = &edited;
  std::string so_far;
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    config::TomlNode* next = step_into(*node, segments[i]);
    if (!next) {
      report_dead_end(path, so_far, segments[i], *node, problems);
      return edited;
    }
    node = next;
    so_far += (so_far.empty() ? "" : ".") + segments[i];
  }
  const std::string& last = segments.back();
  if (last == "center" && node->key == "slab_z" && node->kind == Kind::array && node->items.size() == 2) {
    move_slab(*node, setting, problems);
    return edited;
  }
  config::TomlNode* target = step_into(*node, last);
  const bool whole_entry = target && node->kind == Kind::array && target->kind == Kind::table;
  if (whole_entry) {
    problems.add(path.where, "the " + path.role + " \"" + path.key + "\" names a whole table, not a key",
                 "go on with one of its keys, as \"" + path.key + ".surface\"");
    return edited;
  }
  if (!target) {
    if (node->kind != Kind::table || last.empty()) {
      report_dead_end(path, so_far, last, *node, problems);
      return edited;
    }
    target = &node->items.emplace_back();
  }
  *target = setting.value;
  target->key = node->kind == Kind::table ? last : "";
  target->key_where = setting.path.where;  // once for all values: a wrong key is one mistake
  return edited;
}

}  // namespace

config::TomlNode with_value(const config::TomlNode& document, const KeySetting& setting,
                            core::Problems& problems) {
  config::TomlNode edited = with_one_value(document, setting, problems);
  KeySetting other = setting;
  for (const std::string& key : setting.path.also) {
    other.path.key = key;
    edited = with_one_value(edited, other, problems);
  }
  return edited;
}

}  // namespace scintray::scene_file
