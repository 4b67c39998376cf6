#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/detail/build_steps.hpp"

namespace scintray::scene {

namespace {

/// True when all inputs of a scene, apart from the light of its source, are equal, at the same places of the
/// file.
bool same_parts(const scene_file::SceneSpec& a, const scene_file::SceneSpec& b) {
  return a.ambient == b.ambient && a.contacts_default == b.contacts_default &&
         a.contacts_default_given == b.contacts_default_given && a.folder == b.folder &&
         a.run.contact_tolerance_mm == b.run.contact_tolerance_mm && a.run.accelerator == b.run.accelerator &&
         a.run.curved == b.run.curved && a.run.polarisation == b.run.polarisation && a.readout == b.readout &&
         a.parts == b.parts && a.groups == b.groups && a.contacts == b.contacts &&
         same_definitions(a.media, b.media) && same_definitions(a.surfaces, b.surfaces) &&
         same_definitions(a.sensors, b.sensors) && same_definitions(a.reflectors, b.reflectors);
}

}  // namespace

bool SceneBuilder::serves(const BuiltScene& built, const scene_file::SceneSpec& of,
                          const scene_file::SceneSpec& spec) {
  if (!same_parts(of, spec)) return false;
  const materials::MaterialDatabase& database = this->database(spec);
  core::Problems problems;
  std::vector<std::string> warnings;
  if (find_wavelengths(of, built.placed, database, problems) !=
      find_wavelengths(spec, built.placed, database, problems))
    return false;
  if (problems.empty()) check_sensors(spec, built.placed, built.scene, problems, warnings);
  return problems.empty();
}

}  // namespace scintray::scene
