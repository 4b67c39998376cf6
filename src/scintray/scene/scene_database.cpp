#include <algorithm>

#include "scintray/scene/build_scene.hpp"

namespace scintray::scene {

namespace {

bool same_place(const core::FileLocation& a, const core::FileLocation& b) {
  return a.line == b.line && a.column == b.column && a.file == b.file;
}

/// The same value at the same place of the same file, so that messages are the same too.
bool same_node(const config::TomlNode& a, const config::TomlNode& b) {
  return a.kind == b.kind && a.key == b.key && a.text == b.text && a.number == b.number &&
         a.integer == b.integer && a.boolean == b.boolean && same_place(a.where, b.where) &&
         same_place(a.key_where, b.key_where) &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same_node);
}

bool same_definitions(const std::array<scene_file::InlineTables, 4>& a,
                      const std::array<scene_file::InlineTables, 4>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const scene_file::InlineTables& one, const scene_file::InlineTables& other) {
                      return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                                        [](const auto& x, const auto& y) {
                                          return x.first == y.first &&
                                                 (x.second == y.second || same_node(*x.second, *y.second));
                                        });
                    });
}

}  // namespace

void add_definitions(materials::MaterialDatabase& database, const scene_file::SceneSpec& spec) {
  database.add(materials::DefinitionKind::medium, spec.media);
  database.add(materials::DefinitionKind::surface, spec.surfaces);
  database.add(materials::DefinitionKind::sensor, spec.sensors);
  database.add(materials::DefinitionKind::reflector, spec.reflectors);
}

materials::MaterialDatabase database_for(const scene_file::SceneSpec& spec) {
  materials::MaterialDatabase database = materials::MaterialDatabase::shipped();
  add_definitions(database, spec);
  return database;
}

const materials::MaterialDatabase& SceneBuilder::database(const scene_file::SceneSpec& spec) {
  if (!shipped_) shipped_ = materials::MaterialDatabase::shipped();
  const OwnDefinitions own{spec.media, spec.surfaces, spec.sensors, spec.reflectors};
  if (database_ && same_definitions(own, own_)) return *database_;
  database_ = shipped_;
  add_definitions(*database_, spec);
  own_ = own;
  return *database_;
}

materials::MaterialDatabase::Readings SceneBuilder::readings() const {
  return shipped_ ? shipped_->readings() : materials::MaterialDatabase::Readings{};
}

}  // namespace scintray::scene
