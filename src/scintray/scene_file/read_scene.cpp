#include "scintray/scene_file/read_scene.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "scintray/core/pattern.hpp"
#include "scintray/scene_file/detail/bodies.hpp"
#include "scintray/scene_file/detail/names.hpp"
#include "scintray/scene_file/detail/side_faces.hpp"
#include "scintray/scene_file/readout.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

/// The type of a [source] of photons.
constexpr const char* kPhotonSource = "photons";

InlineTables read_definitions(const config::TomlTable& scene, const std::string& key) {
  InlineTables definitions;
  const std::optional<config::TomlTable> tables = scene.optional_table(key);
  if (!tables) return definitions;
  for (const std::string& name : tables->keys()) {
    const config::TomlNodePtr node = tables->take(name);
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

void read_all_definitions(const config::TomlTable& root, SceneSpec& scene) {
  scene.media = read_definitions(root, "media");
  scene.surfaces = read_definitions(root, "surfaces");
  scene.sensors = read_definitions(root, "sensors");
  scene.reflectors = read_definitions(root, "reflectors");
}

/// The electric field of a source's photons; that of a beam must not lie along it.
std::optional<core::Vec3> read_field(const config::TomlTable& table, const DirectionSpec& direction) {
  const std::optional<core::Vec3> field = table.optional_direction("polarisation");
  if (field && direction.kind == DirectionKind::beam)
    table.expect("polarisation", field->cross(direction.axis).norm() > 1e-6,
                 "the electric field lies along the direction of the beam",
                 "give a vector across the direction; its part across it is the polarisation");
  return field;
}

/// [source], of any type, into `scene`; `parts` are the names of its parts.
void read_source(const config::TomlTable& root, const std::vector<std::string>& parts, SceneSpec& scene) {
  const config::TomlTable table = root.table("source");
  scene.source.where = table.where();
  std::vector<std::string> types{kPhotonSource};
  for (const core::Word<GammaSourceType>& type : kGammaSourceTypes) types.emplace_back(type.word);
  const std::string type = table.choice("type", types);
  if (table.has("type") && !table.good("type")) {
    table.skip();
    return;
  }
  if (type == kPhotonSource) {
    const config::TomlNode* state = table.node()->find("polarisation");
    const bool field = state && state->kind == config::TomlNode::Kind::array;
    const bool unpolarised = !field && table.choice("polarisation", kUnpolarised, false);
    scene.source = read_photon_source(table, parts);
    scene.source.unpolarised = unpolarised;
    if (field) scene.source.polarisation = read_field(table, scene.source.direction);
  } else {
    scene.energy_source = read_gamma_source(table, parts);
  }
}

/// Reports phases requested of light that has none.
void expect_polarised(const config::TomlTable& root, const SceneSpec& scene) {
  const bool unpolarised = scene.energy_source ? scene.energy_source->unpolarised : scene.source.unpolarised;
  if (unpolarised && scene.run.polarisation == PolarisationState::elliptical)
    root.report("run",
                "the polarisation of photons is elliptical, but the light of the source is unpolarised",
                "write polarisation = \"random\" in [source], or remove it from [run]");
}

/// Reports conditions of [run] until that the rest of the scene does not have: events, or a tally.
void expect_goal(const config::TomlTable& root, const SceneSpec& scene) {
  if (!scene.run.until) return;
  const UntilSpec& until = *scene.run.until;
  if (until.events && !scene.energy_source)
    root.report("run", "\"until\" has a number of events, but the source emits photons",
                "give photons in until, or use an event source (docs/gamma_sources.md)");
  const config::TomlTable table = root.table("run").table("until");
  if (is_of_events(until.of) && !scene.energy_source)
    table.report("of", "a result of events, but the source emits photons",
                 "name a fate or a tally, or use an event source (docs/gamma_sources.md)");
  if (until.of != UntilGoal::tally || !table.good("tally")) return;
  std::vector<std::string> names;
  for (const TallySpec& tally : scene.tallies) names.push_back(tally.name);
  const auto named = std::find(names.begin(), names.end(), until.tally.name);
  if (named == names.end()) {
    const core::InputError unknown = core::unknown_name(until.tally.where, "tally", until.tally.name, names);
    const core::Problem& problem = unknown.problems().front();
    return table.report("tally", problem.what, problem.hint);
  }
  const TallySpec& tally = scene.tallies[static_cast<std::size_t>(named - names.begin())];
  if (tally.score && until.absolute_error)
    table.report("absolute_error", "the tally sums \"" + tally.score->name + "\", not photons",
                 "give relative_error");
}

/// Collector that reports common problems of several sweeps and points once.
class DistinctProblems {
 public:
  void add(const core::Problems& problems) {
    for (const core::Problem& problem : problems.list())
      if (seen_.insert(problem.text()).second) kept_.add(problem);
  }
  bool empty() const { return kept_.empty(); }
  void throw_if_any() { kept_.throw_if_any(); }

 private:
  std::set<std::string> seen_;
  core::Problems kept_;
};

/// Expands a swept value with "*" to every part that it matches: a sweep can run over an array's elements.
void expand_patterns(std::vector<SweepSpec>& sweeps, const config::TomlNodePtr& document,
                     const mesh::MeshFormats& formats) {
  std::vector<std::string> parts;
  for (SweepSpec& sweep : sweeps) {
    std::vector<config::TomlNode> values;
    for (const config::TomlNode& value : sweep.values) {
      std::vector<std::string> found;
      if (value.kind == Kind::string && core::is_pattern(value.text)) {
        core::Problems reported_when_the_scene_is_read;
        if (parts.empty()) {
          const Bodies bodies =
              read_bodies(config::TomlTable(document, reported_when_the_scene_is_read), formats);
          parts = part_names(bodies.parts, bodies.groups);
        }
        found = core::matching(value.text, parts);
      }
      if (found.empty()) values.push_back(value);
      for (const std::string& name : found) {
        values.push_back(value);
        values.back().text = name;
      }
    }
    sweep.values = std::move(values);
  }
}

SceneSpec read_from(const config::TomlTable& root, const std::string& text, const Extensions& extensions) {
  SceneSpec scene;
  scene.file = root.where().file;
  scene.folder = scene.file.parent_path();
  scene.text = text;
  scene.title = root.string("title", "");
  scene.ambient = read_name(root, "ambient", true);
  scene.contacts_default_given = root.has("contacts_default");
  scene.contacts_default = root.choice("contacts_default", kContactKinds, ContactKind::bonded);
  Bodies bodies = read_bodies(root, extensions.mesh_formats);
  const std::vector<std::string> names =
      bodies.names_known ? part_names(bodies.parts, bodies.groups) : std::vector<std::string>{};
  scene.parts = std::move(bodies.parts);
  scene.groups = std::move(bodies.groups);
  scene.contacts = read_contacts(root, names, scene.parts);
  scene.gaps = read_gaps(root, names);
  std::move(bodies.contacts.begin(), bodies.contacts.end(), std::back_inserter(scene.contacts));
  read_source(root, names, scene);
  scene.run = read_run(root);
  expect_polarised(root, scene);
  scene.readout = read_readout(root);
  scene.analysis = read_analysis(root);
  scene.criteria = read_criteria(root);
  scene.goniometers = read_goniometers(root);
  scene.tallies =
      read_tallies(root, scene.parts, part_names(scene.parts, scene.groups), extensions.variables);
  expect_goal(root, scene);
  name_sides(scene);
  read_all_definitions(root, scene);
  scene.surfaces.merge(bodies.surfaces);
  scene.fit = read_fit(root);
  read_sweeps(root);
  return scene;
}

}  // namespace

SceneSpec read_scene(const config::TomlNodePtr& document, const std::string& text, core::Problems& problems,
                     const Extensions& extensions) {
  const config::TomlTable root(document, problems);
  SceneSpec scene = read_from(root, text, extensions);
  root.finish();
  return scene;
}

std::vector<std::string> scene_keys(const config::TomlNodePtr& document) {
  core::Problems ignored;
  const config::TomlTable root(document, ignored);
  read_from(root, "", {});
  return root.known_keys();
}

std::vector<config::KeyUse> scene_key_uses(const config::TomlNodePtr& document) {
  core::Problems ignored;
  const config::TomlTable root(document, ignored);
  root.record_uses();
  read_from(root, "", {});
  return root.key_uses();
}

SceneFile SceneFile::load(const std::filesystem::path& path, const Extensions& extensions) {
  return from_text(config::read_text_file(path), path.string(), extensions);
}

SceneFile SceneFile::from_text(const std::string& text, const std::string& file,
                               const Extensions& extensions) {
  SceneFile scene;
  scene.extensions_ = std::make_shared<const Extensions>(extensions);
  scene.text_ = text;
  scene.document_ = config::parse_toml(text, file);
  DistinctProblems found;
  core::Problems sweep_problems;
  scene.sweeps_ = read_sweeps(config::TomlTable(scene.document_, sweep_problems));
  expand_patterns(scene.sweeps_, scene.document_, extensions.mesh_formats);
  const auto try_point = [&](std::size_t point, const std::vector<KeySetting>& settings = {}) {
    core::Problems problems;
    SceneSpec spec = scene.read_point(point, settings, problems);
    found.add(problems);
    return spec;
  };
  // Every value once, not every combination: the number of combinations is a product.
  const SceneSpec first = try_point(0);
  if (first.fit)
    for (const FitParameterSpec& parameter : first.fit->parameters)
      for (const double value : {parameter.start, parameter.low, parameter.high})
        try_point(0, {parameter.setting(value)});
  std::size_t stride = scene.points();
  for (const SweepSpec& sweep : scene.sweeps_) {
    stride /= sweep.values.size();
    for (std::size_t i = 1; i < sweep.values.size(); ++i) try_point(i * stride);
  }
  if (!found.empty()) {  // definitions will not be read
    core::Problems names;
    expect_definitions(first, names);
    found.add(names);
  }
  found.throw_if_any();
  return scene;
}

SceneSpec SceneFile::load_readable(const std::filesystem::path& path) {
  const std::string text = config::read_text_file(path);
  core::Problems reported_by_load;
  return read_scene(config::parse_toml(text, path.string()), text, reported_by_load);
}

SceneSpec SceneFile::load_definitions(const std::filesystem::path& path) {
  const std::string text = config::read_text_file(path);
  const config::TomlNodePtr document = config::parse_toml(text, path.string());
  core::Problems problems, of_the_scene;
  SceneSpec scene;
  read_all_definitions(config::TomlTable(document, problems), scene);
  problems.throw_if_any();
  scene.surfaces.merge(read_bodies(config::TomlTable(document, of_the_scene)).surfaces);
  return scene;
}

std::vector<DefinitionRef> SceneFile::unused_definitions() const {
  return scene_file::unused_definitions(spec(0), *document_);
}

std::size_t SceneFile::points() const {
  std::size_t product = 1;
  for (const SweepSpec& sweep : sweeps_) product *= sweep.values.size();
  return product;
}

std::vector<KeyPath> SceneFile::sweep_paths() const {
  std::vector<KeyPath> paths;
  for (const SweepSpec& sweep : sweeps_) paths.push_back(sweep.path);
  return paths;
}

std::size_t SceneFile::sweep_values(std::size_t sweep) const { return sweeps_.at(sweep).values.size(); }

std::vector<std::string> SceneFile::sweep_keys() const {
  std::vector<std::string> keys;
  for (const SweepSpec& sweep : sweeps_) keys.push_back(sweep.label);
  return keys;
}

const config::TomlNode& SceneFile::value_at(std::size_t point, std::size_t sweep) const {
  std::size_t faster = 1;
  for (std::size_t i = sweep + 1; i < sweeps_.size(); ++i) faster *= sweeps_[i].values.size();
  return sweeps_[sweep].values[point / faster % sweeps_[sweep].values.size()];
}

std::vector<std::string> SceneFile::parameters(std::size_t point) const {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < sweeps_.size(); ++i) values.push_back(value_at(point, i).as_written());
  return values;
}

SceneSpec SceneFile::read_point(std::size_t point, const std::vector<KeySetting>& settings,
                                core::Problems& problems) const {
  config::TomlNode edited = *document_;
  for (std::size_t i = 0; i < sweeps_.size(); ++i)
    edited = with_value(edited, {sweeps_[i].path, value_at(point, i)}, problems);
  for (const KeySetting& setting : settings) edited = with_value(edited, setting, problems);
  return read_scene(std::make_shared<const config::TomlNode>(std::move(edited)), text_, problems,
                    *extensions_);
}

SceneSpec SceneFile::spec(std::size_t point) const { return spec(point, {}); }

SceneSpec SceneFile::spec(std::size_t point, const std::vector<KeySetting>& settings) const {
  core::Problems problems;
  SceneSpec scene = read_point(point, settings, problems);
  problems.throw_if_any();
  return scene;
}

}  // namespace scintray::scene_file
