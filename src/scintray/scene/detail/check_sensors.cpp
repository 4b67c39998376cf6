#include <algorithm>

#include "scintray/core/pattern.hpp"
#include "scintray/scene/detail/build_steps.hpp"

namespace scintray::scene {

namespace {

/// Regions that light from `start` can reach through interfaces that are not opaque both ways.
std::vector<bool> lit_regions(const Scene& scene, const std::vector<std::uint32_t>& start) {
  const auto passes = [&](const Interface& i, bool from_back) {
    const auto opaque = [&](std::int32_t id) {
      return id != kNone && scene.surfaces[static_cast<std::size_t>(id)].opaque();
    };
    const std::uint32_t next = from_back ? i.front : i.back;
    return !opaque(i.back_surface) && !opaque(i.front_surface) &&
           !scene.media[scene.regions[next].medium].is_opaque();
  };
  std::vector<bool> lit(scene.regions.size(), false);
  for (const std::uint32_t region : start) lit[region] = true;
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
std::vector<std::uint32_t> starting_regions(const scene_file::SceneSpec& spec, const Scene& scene) {
  std::vector<std::uint32_t> regions;
  if (spec.energy_source) {
    for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
      if (scene.media[scene.regions[i].medium].medium().yield_per_keV > 0.0) regions.push_back(i);
  } else if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec.source.origin)) {
    for (const PartInfo& part : scene.parts)
      if (core::matches_pattern(region->part.name, part.name)) regions.push_back(part.region);
  } else {
    regions.push_back(scene.locate(std::get<core::Vec3>(spec.source.origin)));
  }
  return regions;
}

}  // namespace

void check_sensors(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                   const Scene& scene, core::Problems& problems, std::vector<std::string>& warnings) {
  const std::vector<std::uint32_t> start = starting_regions(spec, scene);
  if (start.empty()) return;  // the source reports it
  const std::vector<bool> lit = lit_regions(scene, start);
  bool any_sensor = false;
  for (const contact::PlacedMesh& part : placed)
    any_sensor |=
        !part.sensor.empty() || std::any_of(part.faces.begin(), part.faces.end(),
                                            [](const contact::PlacedFace& f) { return !f.sensor.empty(); });
  if (!any_sensor) warnings.push_back("the scene has no sensor: no photon can be detected");
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (!placed[i].sensor.empty() && !lit[i + 1])
      problems.add(
          placed[i].where, "no light from the source can reach sensor \"" + placed[i].name + "\"",
          "something opaque lies between: check the surfaces of the faces on the way, and that the parts "
          "touch (scintray check lists every interface)");
}

}  // namespace scintray::scene
