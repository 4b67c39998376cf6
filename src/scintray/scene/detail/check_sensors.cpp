#include <fmt/format.h>

#include <algorithm>

#include "scintray/core/pattern.hpp"
#include "scintray/scene/detail/build_steps.hpp"

namespace scintray::scene {

namespace {

/// Regions that light from `start` can reach through interfaces that are not opaque in its direction; into
/// opaque parts too, and not beyond.
core::IdVector<core::RegionId, bool> lit_regions(const Scene& scene,
                                                 const std::vector<core::RegionId>& start) {
  const auto passes = [&](const Interface& i, bool from_back) {
    const auto opaque = [&](core::SurfaceId id) { return id.has_value() && scene.surfaces[id].opaque(); };
    const core::RegionId from = from_back ? i.back : i.front;
    const bool each_side =
        i.back_surface.has_value() && i.front_surface.has_value() && !i.gap_medium.has_value();
    return (!opaque(i.back_surface) || (each_side && !from_back)) &&
           (!opaque(i.front_surface) || (each_side && from_back)) &&
           !scene.media[scene.regions[from].medium].is_opaque();
  };
  core::IdVector<core::RegionId, bool> lit(scene.regions.size(), false);
  for (const core::RegionId region : start) lit[region] = true;
  for (bool grew = true; grew;) {
    grew = false;
    for (const Interface& i : scene.interfaces) {
      if (lit[i.back] && !lit[i.front] && passes(i, true)) lit[i.front] = grew = true;
      if (lit[i.front] && !lit[i.back] && passes(i, false)) lit[i.back] = grew = true;
    }
  }
  return lit;
}

/// Regions in which light of the source may start.
std::vector<core::RegionId> starting_regions(const scene_file::SceneSpec& spec, const Scene& scene) {
  std::vector<core::RegionId> regions;
  if (spec.energy_source && std::holds_alternative<scene_file::PhotonListSpec>(spec.energy_source->kind)) {
    // Photons of a list may start anywhere: a part in which none starts is lit by others.
    for (const core::RegionId region : scene.regions.ids())
      if (!scene.media[scene.regions[region].medium].is_opaque()) regions.push_back(region);
  } else if (spec.energy_source) {
    for (const core::RegionId region : scene.regions.ids())
      if (scene.media[scene.regions[region].medium].medium().yield_per_keV > 0.0) regions.push_back(region);
  } else if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec.source.origin)) {
    for (const PartInfo& part : scene.parts)
      if (core::matches_pattern(region->part.name, part.name)) regions.push_back(part.region);
  } else {
    regions.push_back(scene.locate(std::get<core::Vec3>(spec.source.origin)));
  }
  return regions;
}

/// A warning of sensors that are placed at a part with a gap that nothing fills: glue is often forgotten.
void warn_of_empty_gaps(const scene_file::SceneSpec& spec, std::vector<std::string>& warnings) {
  for (const scene_file::PartSpec& part : spec.parts) {
    const std::optional<scene_file::TouchSpec>& touch = part.placement.touch;
    if (part.sensor.empty() || !touch || !(touch->gap_mm > 0.0) || !touch->fill.empty()) continue;
    warnings.push_back(fmt::format(
        "sensor \"{}\" is {:g} mm from \"{}\", by the gap at {}, which holds the ambient medium ({}) "
        "and reflects light back: write fill = \"optical_grease\" beside the gap to couple it",
        part.name.name, touch->gap_mm, touch->part.name, touch->where.text(), spec.ambient.name));
  }
}

/// True when light reaches a surface of the sensor's part from outside, and the sensor converts what is
/// absorbed.
bool absorbs_light(const Scene& scene, core::PartId part, const core::IdVector<core::RegionId, bool>& lit) {
  if (!scene.sensors[scene.parts[part].sensor].converts_absorbed()) return false;
  return std::any_of(scene.interfaces.begin(), scene.interfaces.end(), [&](const Interface& i) {
    return (i.front_sensor.has_value() && i.front_sensor_part == part && lit[i.back]) ||
           (i.back_sensor.has_value() && i.back_sensor_part == part && lit[i.front]);
  });
}

}  // namespace

void check_sensors(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                   const Scene& scene, core::Problems& problems, std::vector<std::string>& warnings) {
  const std::vector<core::RegionId> start = starting_regions(spec, scene);
  if (start.empty()) return;  // reported by the source
  const core::IdVector<core::RegionId, bool> lit = lit_regions(scene, start);
  bool any_sensor = false;
  for (const contact::PlacedMesh& part : placed)
    any_sensor |=
        !part.sensor.empty() || std::any_of(part.faces.begin(), part.faces.end(),
                                            [](const contact::PlacedFace& f) { return !f.sensor.empty(); });
  warn_of_empty_gaps(spec, warnings);
  if (!any_sensor) warnings.push_back("the scene has no sensor: no photon can be detected");
  for (const core::PartId id : scene.parts.ids()) {
    const contact::PlacedMesh& part = placed[id.index()];
    if (!part.sensor.empty() && !lit[scene.parts[id].region] && !absorbs_light(scene, id, lit))
      problems.add(
          part.where, "no light from the source can reach sensor \"" + part.name + "\"",
          "something opaque lies between: check the surfaces of the faces on the way, and that the parts "
          "touch (scintray check lists every interface)");
  }
}

}  // namespace scintray::scene
