#include "scintray/scene/facet_faces.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "scintray/mesh/smooth_faces.hpp"

namespace scintray::scene {

namespace {

/// What is behind an interface of a face, for light inside the face's part.
struct Beyond {
  core::RegionId inside;
  double index = 1.0;
};

/// The interfaces of a scene at which total reflection may keep light: those with smooth surfaces.
std::multimap<core::FaceId, Beyond> smooth_interfaces(const Scene& scene, double wavelength_nm) {
  std::multimap<core::FaceId, Beyond> all;
  const auto add = [&](core::FaceId face, core::RegionId inside, core::RegionId outside,
                       core::SurfaceId surface, core::MediumId gap) {
    if (!face.has_value() || !surface.has_value() || !scene.surfaces[surface].plain()) return;
    const core::MediumId beyond = gap.has_value() ? gap : scene.regions[outside].medium;
    if (scene.optics.is_opaque(beyond)) return;
    all.emplace(face, Beyond{inside, scene.optics.index(beyond, wavelength_nm)});
  };
  for (const Interface& interface : scene.interfaces) {
    const bool has_back = interface.back_surface.has_value(), has_front = interface.front_surface.has_value();
    add(interface.back_face, interface.back, interface.front,
        has_back ? interface.back_surface : interface.front_surface, interface.gap_medium);
    add(interface.front_face, interface.front, interface.back,
        has_front ? interface.front_surface : interface.back_surface, interface.gap_medium);
  }
  return all;
}

}  // namespace

double light_let_out(const RoundWall& wall) {
  const double sine = wall.index_outside / wall.index_inside;
  if (sine >= 1.0 || !(wall.facet_angle_rad > 0.0)) return 0.0;
  const double reflections =
      1.0 / (wall.absorption_per_mm * wall.mean_chord_mm);  // infinite without absorption
  const double spread = 2.0 * wall.facet_angle_rad * std::sqrt(reflections / 3.0);
  const double reached = std::sin(std::min(std::asin(sine) + spread, 0.5 * core::kPi));
  return reached * reached - sine * sine;
}

std::vector<FacetFace> facet_faces(const BuiltScene& built) {
  const Scene& scene = built.scene;
  std::map<std::string, FacetFace> of_name;
  for (const FaceInfo& face : scene.faces)
    if (!face.curve.empty() && !face.exact) of_name[face.name] = {face.name, true, face.deviation};
  for (const contact::PlacedMesh& part : built.placed) {
    const std::vector<mesh::FacetDeviation> faces =
        mesh::smooth_face_deviations(part.mesh, part.face_of, part.faces.size());
    for (std::size_t face = 0; face < faces.size(); ++face) {
      const std::string name = part.name + ":" + part.faces[face].name;
      if (faces[face].angle_rad > 0.0) of_name[name] = {name, false, faces[face]};
    }
  }
  std::vector<FacetFace> all;
  if (of_name.empty()) return all;
  const double middle_nm = 0.5 * (scene.low_nm + scene.high_nm);
  const auto interfaces = smooth_interfaces(scene, middle_nm);
  core::IdVector<core::PartId, double> areas(scene.parts.size(), 0.0);
  for (const FaceInfo& face : scene.faces) areas[face.part] += face.area_mm2;
  for (const core::FaceId id : scene.faces.ids()) {
    const auto found = of_name.find(scene.faces[id].name);
    if (found == of_name.end()) continue;
    FacetFace face = found->second;
    const core::PartId part = scene.faces[id].part;
    const auto [first, last] = interfaces.equal_range(id);
    for (auto beyond = first; beyond != last; ++beyond) {
      const core::MediumId medium = scene.regions[beyond->second.inside].medium;
      if (scene.optics.is_opaque(medium)) continue;
      const optics::MediumOptics inside = scene.optics.at(medium, middle_nm);
      face.let_out = std::max(
          face.let_out,
          light_let_out({inside.index, beyond->second.index, inside.absorption_per_mm,
                         4.0 * scene.parts[part].volume_mm3 / areas[part], face.deviation.angle_rad}));
    }
    all.push_back(std::move(face));
  }
  return all;
}

}  // namespace scintray::scene
