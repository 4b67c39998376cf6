#include "scintray/scene/read_scene.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "scintray/scene/face_path.hpp"
#include "scintray/scene/read_parts.hpp"

namespace scintray {

namespace {

using Kind = TomlNode::Kind;

InlineTables read_definitions(const TomlTable& scene, const std::string& key) {
  InlineTables definitions;
  const std::optional<TomlTable> tables = scene.optional_table(key);
  if (!tables) return definitions;
  for (const std::string& name : tables->keys()) {
    const TomlNodePtr node = tables->take(name);
    if (node->kind != Kind::table)
      tables->report(name, "\"" + key + "." + name + "\" is not a table",
                     "write [" + key + "." + name + "] and its keys below");
    else if (key == "media" && name == kOpaqueMedium)
      tables->report(name, "\"opaque\" is the medium that absorbs everything and cannot be defined",
                     "choose another name");
    else
      definitions.emplace(name, node);
  }
  return definitions;
}

/// Reports several sweeps' and points' common problems once.
class DistinctProblems {
 public:
  void add(const Problems& problems) {
    for (const Problem& problem : problems.list())
      if (seen_.insert(problem.text()).second) kept_.add(problem);
  }
  void throw_if_any() { kept_.throw_if_any(); }

 private:
  std::set<std::string> seen_;
  Problems kept_;
};

SceneSpec read_from(const TomlTable& root, const std::string& text) {
  SceneSpec scene;
  scene.file = root.where().file;
  scene.folder = scene.file.parent_path();
  scene.text = text;
  scene.title = root.string("title", "");
  scene.ambient = read_name(root, "ambient", true);
  scene.contacts_default_given = root.has("contacts_default");
  scene.contacts_default = contact_kind(root.choice("contacts_default", {"bonded", "dry"}, "bonded"));
  scene.parts = read_parts(root);
  const std::vector<std::string> names = part_names(scene.parts);
  scene.contacts = read_contacts(root, scene.parts);
  scene.source = read_source(root, names);
  scene.run = read_run(root);
  scene.exit_angles = read_tallies(root, scene.parts);
  scene.media = read_definitions(root, "media");
  scene.surfaces = read_definitions(root, "surfaces");
  scene.sensors = read_definitions(root, "sensors");
  scene.reflectors = read_definitions(root, "reflectors");
  read_sweeps(root);
  return scene;
}

}  // namespace

std::vector<ExitAngleTallySpec> read_tallies(const TomlTable& scene, const std::vector<PartSpec>& parts) {
  std::vector<ExitAngleTallySpec> tallies;
  std::set<std::string> names;
  for (const TomlTable& table : scene.tables("tally")) {
    ExitAngleTallySpec tally;
    tally.where = table.where();
    table.choice("type", {"exit_angle"});
    if (table.has("type") && !table.good("type")) {
      table.skip();
      continue;
    }
    if (const auto path = read_face_path(table, "face", table.string("face"), parts)) {
      tally.part = path->part;
      tally.face = path->face;
    }
    tally.name = table.string("name", tally.part.name + ":" + tally.face.name);
    if (table.good("face") && !names.insert(tally.name).second)
      table.report("name", "there are two tallies named \"" + tally.name + "\"",
                   "give each a name of its own");
    tally.detected_only = table.boolean("detected_only", false);
    const std::int64_t bins = table.integer("bins", tally.bins);
    table.expect("bins", bins >= 1 && bins <= 9000, "the number of bins is not in 1 to 9000",
                 "give the number of equal bins over 0 to 90 deg");
    tally.bins = static_cast<int>(bins);
    tallies.push_back(std::move(tally));
  }
  return tallies;
}

SceneSpec read_scene(const TomlNodePtr& document, const std::string& text, Problems& problems) {
  const TomlTable root(document, problems);
  SceneSpec scene = read_from(root, text);
  root.finish();
  return scene;
}

std::vector<std::string> scene_keys(const TomlNodePtr& document) {
  Problems ignored;
  const TomlTable root(document, ignored);
  read_from(root, "");
  return root.known_keys();
}

SceneFile SceneFile::load(const std::filesystem::path& path) {
  return from_text(read_text_file(path), path.string());
}

SceneFile SceneFile::from_text(const std::string& text, const std::string& file) {
  SceneFile scene;
  scene.text_ = text;
  scene.document_ = parse_toml(text, file);
  DistinctProblems found;
  Problems sweep_problems;
  scene.sweeps_ = read_sweeps(TomlTable(scene.document_, sweep_problems));
  const auto try_point = [&](std::size_t point) {
    Problems problems;
    scene.read_point(point, problems);
    found.add(problems);
  };
  // Every value once, not every combination: the number of combinations is a product.
  try_point(0);
  std::size_t stride = scene.points();
  for (const SweepSpec& sweep : scene.sweeps_) {
    stride /= sweep.values.size();
    for (std::size_t i = 1; i < sweep.values.size(); ++i) try_point(i * stride);
  }
  found.throw_if_any();
  return scene;
}

std::size_t SceneFile::points() const {
  std::size_t product = 1;
  for (const SweepSpec& sweep : sweeps_) product *= sweep.values.size();
  return product;
}

std::vector<std::string> SceneFile::sweep_keys() const {
  std::vector<std::string> keys;
  for (const SweepSpec& sweep : sweeps_) keys.push_back(sweep.label);
  return keys;
}

const TomlNode& SceneFile::value_at(std::size_t point, std::size_t sweep) const {
  std::size_t faster = 1;
  for (std::size_t i = sweep + 1; i < sweeps_.size(); ++i) faster *= sweeps_[i].values.size();
  return sweeps_[sweep].values[point / faster % sweeps_[sweep].values.size()];
}

std::vector<std::string> SceneFile::parameters(std::size_t point) const {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < sweeps_.size(); ++i) values.push_back(value_at(point, i).as_written());
  return values;
}

SceneSpec SceneFile::read_point(std::size_t point, Problems& problems) const {
  TomlNode edited = *document_;
  for (std::size_t i = 0; i < sweeps_.size(); ++i)
    edited = with_value(edited, sweeps_[i], value_at(point, i), problems);
  return read_scene(std::make_shared<const TomlNode>(std::move(edited)), text_, problems);
}

SceneSpec SceneFile::spec(std::size_t point) const {
  Problems problems;
  SceneSpec scene = read_point(point, problems);
  problems.throw_if_any();
  return scene;
}

}  // namespace scintray
