#include <set>
#include <string>

#include "scintray/scene/detail/build_steps.hpp"
#include "scintray/scene_file/definitions.hpp"

namespace scintray::scene {

namespace {

using materials::DefinitionKind;

void read(const materials::MaterialDatabase& database, const scene_file::DefinitionRef& definition) {
  const std::string& name = definition.name.name;
  switch (definition.kind) {
    case DefinitionKind::medium:
      database.medium(name);
      return;
    case DefinitionKind::surface:
      database.surface(name);
      return;
    case DefinitionKind::sensor:
      database.sensor(name);
      return;
    case DefinitionKind::reflector:
      database.reflector(name);
      return;
  }
  throw core::InternalError("unknown kind of definition");
}

/// Surfaces on which others of the scene are based.
std::set<std::string> bases_of(const scene_file::InlineTables& surfaces) {
  std::set<std::string> bases;
  for (const auto& [name, node] : surfaces)
    if (const config::TomlNode* base = node->find("base")) bases.insert(base->text);
  return bases;
}

}  // namespace

void check_definitions(const scene_file::SceneSpec& spec, const materials::MaterialDatabase& database,
                       core::Problems& problems) {
  std::set<std::string> reported;
  for (const core::Problem& problem : problems.list()) reported.insert(problem.text());
  const std::set<std::string> bases = bases_of(spec.surfaces);
  for (const scene_file::DefinitionRef& own : scene_file::own_definitions(spec)) {
    try {
      // What a base lacks is given by those that are based on it.
      const bool is_base = own.kind == DefinitionKind::surface && bases.contains(own.name.name);
      if (is_base && !database.outline(own.name.name).needs.empty()) continue;
      read(database, own);
    } catch (const core::InputError& error) {
      for (const core::Problem& problem : error.problems())
        if (reported.insert(problem.text()).second) problems.add(problem);
    }
  }
}

}  // namespace scintray::scene
