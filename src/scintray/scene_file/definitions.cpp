#include "scintray/scene_file/definitions.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace scintray::scene_file {

namespace {

using materials::DefinitionKind;

constexpr core::Word<DefinitionKind> kTables[] = {{"media", DefinitionKind::medium},
                                                  {"surfaces", DefinitionKind::surface},
                                                  {"sensors", DefinitionKind::sensor},
                                                  {"reflectors", DefinitionKind::reflector}};

/// Keys whose values are no names of definitions.
const std::set<std::string> kOtherNames{"title", "name", "part", "source_part", "touch", "between", "face"};

/// Collects names, each once.
class Collector {
 public:
  void add(DefinitionKind kind, const config::NameRef& name) {
    if (name.empty() || (kind == DefinitionKind::medium && name.name == kOpaqueMedium)) return;
    if (seen_.emplace(kind, name.name).second) list_.push_back({kind, name});
  }
  void add_medium(const config::NameRef& name) { add(DefinitionKind::medium, name); }
  void add_surface(const config::NameRef& name) { add(DefinitionKind::surface, name); }
  void add_sensor(const config::NameRef& name) { add(DefinitionKind::sensor, name); }
  std::vector<DefinitionRef> list() { return std::move(list_); }

 private:
  std::set<std::pair<DefinitionKind, std::string>> seen_;
  std::vector<DefinitionRef> list_;
};

void add_part(const PartSpec& part, Collector& names) {
  names.add_medium(part.medium);
  names.add_surface(part.surface);
  names.add_sensor(part.sensor);
  if (part.placement.touch) names.add_medium(part.placement.touch->fill);
  for (const FaceRuleSpec& face : part.faces) {
    names.add_surface(face.surface);
    names.add_sensor(face.sensor);
  }
}

/// Adds all texts of the node but the values of those keys: tables of the same name, [[part]], have their own
/// keys.
/// @param other  the node is the value of such a key, or in its list
void add_values(const config::TomlNode& node, bool other, std::set<std::string>& values) {
  if (node.kind == config::TomlNode::Kind::string && !other) values.insert(node.text);
  for (const config::TomlNode& item : node.items)
    add_values(item, item.key.empty() ? other : kOtherNames.contains(item.key), values);
}

}  // namespace

std::vector<DefinitionRef> named_definitions(const SceneSpec& scene) {
  Collector names;
  names.add_medium(scene.ambient);
  for (const PartSpec& part : scene.parts) add_part(part, names);
  for (const GroupSpec& group : scene.groups)
    if (group.placement.touch) names.add_medium(group.placement.touch->fill);
  for (const ContactSpec& contact : scene.contacts) names.add_surface(contact.surface);
  for (const GoniometerSpec& goniometer : scene.goniometers) {
    names.add_medium(goniometer.inside);
    for (const config::NameRef& outside : goniometer.outside) names.add_medium(outside);
    for (const config::NameRef& surface : goniometer.surfaces) names.add_surface(surface);
  }
  return names.list();
}

void expect_definitions(const SceneSpec& scene, core::Problems& problems) {
  materials::MaterialDatabase database = materials::MaterialDatabase::shipped();
  database.add(DefinitionKind::medium, scene.media);
  database.add(DefinitionKind::surface, scene.surfaces);
  database.add(DefinitionKind::sensor, scene.sensors);
  for (const DefinitionRef& named : named_definitions(scene))
    if (!database.has(named.kind, named.name.name))
      problems.add(database.unknown(named.kind, named.name.name, named.name.where));
}

std::vector<DefinitionRef> own_definitions(const SceneSpec& scene) {
  std::vector<DefinitionRef> list;
  const auto add = [&](DefinitionKind kind, const InlineTables& tables) {
    for (const auto& [name, node] : tables) list.push_back({kind, {name, node->key_where}});
  };
  add(DefinitionKind::medium, scene.media);
  add(DefinitionKind::surface, scene.surfaces);
  add(DefinitionKind::sensor, scene.sensors);
  add(DefinitionKind::reflector, scene.reflectors);
  return list;
}

std::vector<DefinitionRef> unused_definitions(const SceneSpec& scene, const config::TomlNode& document) {
  std::set<std::string> values;
  add_values(document, false, values);
  std::vector<DefinitionRef> unused;
  for (const DefinitionRef& own : own_definitions(scene)) {
    const config::TomlNode* table = document.find(core::word_of(kTables, own.kind));
    const bool in_file = table && table->find(own.name.name);  // the others are made by builders
    if (in_file && !values.contains(own.name.name)) unused.push_back(own);
  }
  std::sort(unused.begin(), unused.end(), [](const DefinitionRef& a, const DefinitionRef& b) {
    return a.name.where.line < b.name.where.line;
  });
  return unused;
}

std::string definition_key(const DefinitionRef& definition) {
  return std::string(core::word_of(kTables, definition.kind)) + "." + definition.name.name;
}

}  // namespace scintray::scene_file
