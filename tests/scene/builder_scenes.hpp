#pragma once
/// Scenes with builders, written inside a test and built.

#include <map>
#include <string>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"

namespace scintray::test {

/// A scene around the text of its bodies; light starts in `source_part`.
inline std::string scene_with(const std::string& bodies, const std::string& source_part,
                              const std::string& contacts_default = "bonded") {
  return "ambient = \"clear\"\ncontacts_default = \"" + contacts_default + "\"\n" + bodies + R"(
[source]
type = "photons"
region = { part = ")" +
         source_part + R"(" }
wavelength = "420 nm"
photons = 1
[media.clear]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
[media.crystal]
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
[media.glue]
index = { n = 1.5 }
absorption = { none = true }
scattering = { none = true }
[surfaces.flat]
model = "smooth"
[surfaces.ground]
model = "unified"
unified = { sigma_alpha = "12 deg", definition = "solid_angle", facets = "geant4", lobe = 1.0 }
[reflectors.white]
reflectance = { value = 0.97 }
direction = { specular_share = 0.0 }
)";
}

inline scene::BuiltScene built(const std::string& text) {
  scene::SceneBuilder builder;
  return builder.build(scene_file::SceneFile::from_text(text, "scene.toml").spec(0));
}

inline std::map<std::string, scene::PartInfo> parts_by_name(const scene::Scene& scene) {
  std::map<std::string, scene::PartInfo> parts;
  for (const scene::PartInfo& part : scene.parts) parts[part.name] = part;
  return parts;
}

inline std::map<std::string, scene::FaceInfo> faces_by_name(const scene::Scene& scene) {
  std::map<std::string, scene::FaceInfo> faces;
  for (const scene::FaceInfo& face : scene.faces) faces[face.name] = face;
  return faces;
}

/// Area between two regions, and the interface there with the largest one.
struct Between {
  double area_mm2 = 0.0;
  scene::Interface interface;
};
inline Between between(const scene::Scene& scene, const std::string& a, const std::string& b) {
  Between found;
  double largest = 0.0;
  for (const core::InterfaceId i : scene.interfaces.ids()) {
    const std::string &back = scene.region_names[scene.interfaces[i].back],
                      &front = scene.region_names[scene.interfaces[i].front];
    if (!(back == a && front == b) && !(back == b && front == a)) continue;
    found.area_mm2 += scene.interface_area_mm2[i];
    if (scene.interface_area_mm2[i] > largest) {
      largest = scene.interface_area_mm2[i];
      found.interface = scene.interfaces[i];
    }
  }
  return found;
}

}  // namespace scintray::test
