#include <algorithm>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/detail/build_steps.hpp"

namespace scintray::scene {

bool same_definitions(const scene_file::InlineTables& a, const scene_file::InlineTables& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    return one.first == other.first && (one.second == other.second || *one.second == *other.second);
  });
}

namespace {

bool same_own_definitions(const std::array<scene_file::InlineTables, 4>& a,
                          const std::array<scene_file::InlineTables, 4>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const auto& one, const auto& other) { return same_definitions(one, other); });
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
  if (!shipped_) shipped_ = materials::MaterialDatabase::shipped(models_);
  const OwnDefinitions own{spec.media, spec.surfaces, spec.sensors, spec.reflectors};
  if (database_ && same_own_definitions(own, own_)) return *database_;
  database_ = shipped_;
  add_definitions(*database_, spec);
  own_ = own;
  return *database_;
}

materials::MaterialDatabase::Readings SceneBuilder::readings() const {
  return shipped_ ? shipped_->readings() : materials::MaterialDatabase::Readings{};
}

}  // namespace scintray::scene
