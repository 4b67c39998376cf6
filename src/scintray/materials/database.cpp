#include "scintray/materials/database.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>

#include "scintray/core/data_folder.hpp"
#include "scintray/core/text.hpp"
#include "scintray/materials/detail/forms.hpp"
#include "scintray/materials/material_forms.hpp"

namespace scintray::materials {

namespace {

struct KindWords {
  const char* one;     ///< in messages
  const char* folder;  ///< below a folder of the database, and the table of a scene file
};

constexpr std::array<KindWords, 4> kKinds{
    {{"medium", "media"}, {"surface", "surfaces"}, {"sensor", "sensors"}, {"reflector", "reflectors"}}};

constexpr std::size_t index_of(DefinitionKind kind) { return static_cast<std::size_t>(kind); }

/// Path of a definition in messages: "surfaces.rough" of a scene's own; empty for a file of its own.
std::string path_of(DefinitionKind kind, const config::TomlNode& definition) {
  return definition.key.empty() ? "" : std::string(kKinds[index_of(kind)].folder) + "." + definition.key;
}

std::string list_or_none(const std::vector<std::string>& words) {
  return words.empty() ? "none" : core::list_of(words);
}

}  // namespace

struct MaterialDatabase::Known {
  // Reading a surface reads the media, reflectors and surfaces that it names.
  std::recursive_mutex mutex;
  std::map<std::string, optics::Medium> media;
  std::map<std::string, SurfaceSpec> surfaces;
  std::map<std::string, detector::Sensor> sensors;
  std::map<std::string, optics::Reflector> reflectors;

  /// The cached definition of a name, read on first use.
  template <typename Definition, typename Read>
  const Definition& once(std::map<std::string, Definition> Known::*kind, const std::string& name,
                         const Read& read) {
    const std::scoped_lock lock(mutex);
    std::map<std::string, Definition>& all = this->*kind;
    if (const auto found = all.find(name); found != all.end()) return found->second;
    Definition definition = read();
    return all.emplace(name, std::move(definition)).first->second;
  }
};

struct MaterialDatabase::Files {
  std::mutex mutex;
  std::map<std::filesystem::path, config::TomlNodePtr> documents;
  Known alone;  ///< definitions that depend on nothing else
  std::atomic<std::size_t> files_read = 0, definitions_read = 0;

  config::TomlNodePtr document(const std::filesystem::path& path) {
    const std::scoped_lock lock(mutex);
    config::TomlNodePtr& known = documents[path];
    if (!known) {
      known = config::parse_toml_file(path);
      ++files_read;
    }
    return known;
  }
};

MaterialDatabase::MaterialDatabase(const std::vector<std::filesystem::path>& folders, DefinitionModels models)
    : models_(std::make_shared<const DefinitionModels>(std::move(models))),
      folders_(folders),
      read_(std::make_shared<Files>()),
      with_own_(std::make_shared<Known>()) {
  core::Problems problems;
  for (const std::filesystem::path& folder : folders) {
    std::error_code status;
    if (!std::filesystem::is_directory(folder, status)) {
      problems.add({}, "the material folder \"" + folder.string() + "\" does not exist",
                   "name a folder that holds media/, surfaces/, sensors/ or reflectors/");
      continue;
    }
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
      const std::filesystem::path below = folder / kKinds[kind].folder;
      if (!std::filesystem::is_directory(below, status)) continue;
      for (const auto& entry : std::filesystem::directory_iterator(below))
        if (entry.path().extension() == ".toml")
          files_[kind].emplace(entry.path().stem().string(), entry.path());
    }
  }
  problems.throw_if_any();
}

MaterialDatabase MaterialDatabase::shipped(DefinitionModels models) {
  return MaterialDatabase({core::data_folder() / "materials"}, std::move(models));
}

void MaterialDatabase::add(DefinitionKind kind,
                           const std::map<std::string, config::TomlNodePtr>& definitions) {
  if (definitions.empty()) return;
  for (const auto& [name, node] : definitions) own_[index_of(kind)].insert_or_assign(name, node);
  with_own_ = std::make_shared<Known>();
}

MaterialDatabase::Readings MaterialDatabase::readings() const {
  return {read_->files_read, read_->definitions_read};
}

MaterialDatabase::Known& MaterialDatabase::known_for(DefinitionKind kind, const std::string& name) const {
  const auto has_own = [this](DefinitionKind of) { return !own_[index_of(of)].empty(); };
  const auto is_own = [&] {
    switch (kind) {
      case DefinitionKind::medium:
      case DefinitionKind::reflector:
        return own_[index_of(kind)].contains(name);
      case DefinitionKind::sensor:
        return has_own(DefinitionKind::sensor);
      case DefinitionKind::surface:
        return has_own(DefinitionKind::medium) || has_own(DefinitionKind::surface) ||
               has_own(DefinitionKind::reflector);
    }
    throw core::InternalError("unknown kind of definition");
  };
  return is_own() ? *with_own_ : read_->alone;
}

std::vector<std::string> MaterialDatabase::names(DefinitionKind kind) const {
  std::set<std::string> all;
  for (const auto& [name, node] : own_[index_of(kind)]) all.insert(name);
  for (const auto& [name, path] : files_[index_of(kind)]) all.insert(name);
  return {all.begin(), all.end()};
}

bool MaterialDatabase::has(DefinitionKind kind, const std::string& name) const {
  return own_[index_of(kind)].contains(name) || files_[index_of(kind)].contains(name);
}

core::Problem MaterialDatabase::unknown(DefinitionKind kind, const std::string& name,
                                        const core::FileLocation& where) const {
  const KindWords& words = kKinds[index_of(kind)];
  const std::vector<std::string> known = names(kind);
  const std::string near = core::nearest_word(name, known);
  std::vector<std::string> places;
  for (const std::filesystem::path& folder : folders_) places.push_back((folder / words.folder).string());
  places.push_back(std::string("[") + words.folder + ".NAME] of the scene");
  return {where, std::string("there is no ") + words.one + " \"" + name + "\"",
          (near.empty() ? "" : "did you mean \"" + near + "\"? ") + std::string("known: ") +
              list_or_none(known) + "; searched: " + list_or_none(places)};
}

MaterialDatabase::Definition MaterialDatabase::find(DefinitionKind kind, const std::string& name,
                                                    const core::FileLocation& where) const {
  const auto& own = own_[index_of(kind)];
  if (const auto found = own.find(name); found != own.end()) return {found->second, false};
  const auto& files = files_[index_of(kind)];
  if (const auto found = files.find(name); found != files.end())
    return {read_->document(found->second), true};
  throw core::InputError(unknown(kind, name, where));
}

const optics::Medium& MaterialDatabase::medium(const std::string& name,
                                               const core::FileLocation& where) const {
  return known_for(DefinitionKind::medium, name).once(&Known::media, name, [&] {
    return read_medium_of(name, where);
  });
}

optics::Medium MaterialDatabase::read_medium_of(const std::string& name,
                                                const core::FileLocation& where) const {
  const Definition definition = find(DefinitionKind::medium, name, where);
  core::Problems problems;
  const config::TomlTable table(definition.node, problems, path_of(DefinitionKind::medium, *definition.node));
  optics::Medium medium =
      read_medium(table, name, definition.from_file ? SourceRule::required : SourceRule::optional);
  table.finish();
  problems.throw_if_any();
  ++read_->definitions_read;
  return medium;
}

const detector::Sensor& MaterialDatabase::sensor(const std::string& name,
                                                 const core::FileLocation& where) const {
  return known_for(DefinitionKind::sensor, name).once(&Known::sensors, name, [&] {
    return read_sensor_of(name, where);
  });
}

config::TomlNode MaterialDatabase::merged_sensor(const std::vector<Ancestor>& ancestors) const {
  config::TomlNode merged = *ancestors.front().definition.node;
  for (const Ancestor& ancestor : ancestors) {
    const std::string model = models_->sensors.stated_by(merged);
    for (const config::TomlNode& item : ancestor.definition.node->items)
      if (!merged.find(item.key) && models_->sensors.belongs_to(item, model)) merged.items.push_back(item);
  }
  return merged;
}

detector::Sensor MaterialDatabase::read_sensor_of(const std::string& name,
                                                  const core::FileLocation& where) const {
  const std::vector<Ancestor> ancestors = lineage(DefinitionKind::sensor, name, where);
  const Definition& own = ancestors.front().definition;
  config::TomlNode merged = merged_sensor(ancestors);
  core::Problems problems;
  const std::string path = path_of(DefinitionKind::sensor, merged);
  const config::TomlTable table(std::make_shared<const config::TomlNode>(std::move(merged)), problems, path);
  table.optional_string("base");  // followed above
  detector::Sensor sensor =
      read_sensor(table, name, own.from_file ? SourceRule::required : SourceRule::optional, models_->sensors);
  table.finish();
  problems.throw_if_any();
  ++read_->definitions_read;
  return sensor;
}

const optics::Reflector& MaterialDatabase::reflector(const std::string& name,
                                                     const core::FileLocation& where) const {
  return known_for(DefinitionKind::reflector, name).once(&Known::reflectors, name, [&] {
    return read_reflector_of(name, where);
  });
}

optics::Reflector MaterialDatabase::read_reflector_of(const std::string& name,
                                                      const core::FileLocation& where) const {
  const Definition definition = find(DefinitionKind::reflector, name, where);
  core::Problems problems;
  const config::TomlTable table(definition.node, problems,
                                path_of(DefinitionKind::reflector, *definition.node));
  optics::Reflector reflector =
      read_reflector(table, name, definition.from_file ? SourceRule::required : SourceRule::optional);
  table.finish();
  problems.throw_if_any();
  ++read_->definitions_read;
  return reflector;
}

std::vector<MaterialDatabase::Ancestor> MaterialDatabase::lineage(DefinitionKind kind,
                                                                  const std::string& name,
                                                                  const core::FileLocation& where) const {
  std::vector<Ancestor> ancestors;
  std::vector<std::string> names;
  for (std::string next = name; !next.empty();) {
    const core::FileLocation requested =
        ancestors.empty() ? where : ancestors.back().definition.node->find("base")->where;
    const std::string one = kKinds[index_of(kind)].one;
    if (std::find(names.begin(), names.end(), next) != names.end())
      throw core::InputError(
          {requested,
           fmt::format("the {} \"{}\" is based on itself ({}, {})", one, next, list_or_none(names), next),
           fmt::format("base it on another {}", one)});
    names.push_back(next);
    ancestors.push_back({next, find(kind, next, requested)});
    core::Problems problems;
    next = config::TomlTable(ancestors.back().definition.node, problems).optional_string("base").value_or("");
    problems.throw_if_any();
  }
  return ancestors;
}

MaterialDatabase::Chain MaterialDatabase::chain(const std::string& surface, const core::FileLocation& where,
                                                core::Problems& problems) const {
  Chain chain;
  const std::vector<Ancestor> ancestors = lineage(DefinitionKind::surface, surface, where);
  for (const Ancestor& ancestor : ancestors) {
    chain.names.push_back(ancestor.name);
    const Definition& definition = ancestor.definition;
    read_source(config::TomlTable(definition.node, problems),
                definition.from_file ? SourceRule::required : SourceRule::optional, chain.sources);
  }
  problems.throw_if_any();
  chain.merged = *ancestors.back().definition.node;
  for (std::size_t i = ancestors.size() - 1; i-- > 0;)
    chain.merged = merge_over_base(chain.merged, *ancestors[i].definition.node, models_->surfaces);
  return chain;
}

SurfaceOutline MaterialDatabase::outline(const std::string& surface, const core::FileLocation& where) const {
  core::Problems problems;
  Chain found = chain(surface, where, problems);
  const config::TomlNode* model = found.merged.find("model");
  std::vector<std::string> sources;  // each once: bases often name the same
  for (std::string& source : found.sources)
    if (std::find(sources.begin(), sources.end(), source) == sources.end())
      sources.push_back(std::move(source));
  return {model                          ? model->text
          : found.merged.find("mixture") ? "mixture"
                                         : "",
          {found.names.begin() + 1, found.names.end()},
          missing_needs(found.merged),
          std::move(sources)};
}

const SurfaceSpec& MaterialDatabase::surface(const std::string& name, const core::FileLocation& where) const {
  return surface(name, where, {});
}

const SurfaceSpec& MaterialDatabase::surface(const std::string& name, const core::FileLocation& where,
                                             const std::vector<std::string>& within) const {
  if (std::find(within.begin(), within.end(), name) != within.end())
    throw core::InputError(
        {where, "the surface \"" + name + "\" is a mixture of itself (" + list_or_none(within) + ")",
         "mix other surfaces"});
  return known_for(DefinitionKind::surface, name).once(&Known::surfaces, name, [&] {
    return read_surface_of(name, where, within);
  });
}

SurfaceSpec MaterialDatabase::read_surface_of(const std::string& name, const core::FileLocation& where,
                                              const std::vector<std::string>& within) const {
  core::Problems problems;
  Chain chain = this->chain(name, where, problems);
  const std::vector<std::string> missing = missing_needs(chain.merged);
  if (!missing.empty())
    throw core::InputError(
        {chain.names.size() == 1 && !where.file.empty() ? where : chain.merged.where,
         "the surface \"" + name + "\" requires parameters that are not given: " + list_or_none(missing),
         chain.names.size() == 1 ? "define your own: [surfaces.NAME] with base = \"" + name +
                                       "\" and these keys, and name that one"
                                 : "add these keys beside base = \"" + chain.names[1] + "\""});

  const SurfaceLookup lookup{[this](const std::string& medium_name, const core::FileLocation& at) {
                               return medium(medium_name, at);
                             },
                             [&](const std::string& part, const core::FileLocation& at) {
                               std::vector<std::string> around = within;
                               around.push_back(name);
                               return surface(part, at, around);
                             },
                             [this](const std::string& reflector_name, const core::FileLocation& at) {
                               return reflector(reflector_name, at);
                             },
                             models_->surfaces};
  const std::string path = path_of(DefinitionKind::surface, chain.merged);
  const config::TomlTable table(std::make_shared<const config::TomlNode>(std::move(chain.merged)), problems,
                                path);
  SurfaceSpec surface = read_surface(table, name, lookup, problems);
  table.finish();
  problems.throw_if_any();
  surface.sources = std::move(chain.sources);
  ++read_->definitions_read;
  return surface;
}

}  // namespace scintray::materials
