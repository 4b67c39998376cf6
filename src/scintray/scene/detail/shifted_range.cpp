#include "scintray/scene/detail/shifted_range.hpp"

#include <algorithm>
#include <set>

namespace scintray::scene {

namespace {

/// Where an emission spectrum ends: the last point, or the first of the zeros at its end.
double end_of(const core::Curve& emission) {
  std::size_t last = emission.y().size() - 1;
  while (last > 0 && emission.y()[last - 1] == 0.0) --last;
  return emission.x()[last];
}

double longest_of(const materials::SurfaceSpec& surface) {
  double longest = surface.gap_shifter ? end_of(surface.gap_shifter->emission()) : 0.0;
  for (const materials::ShareSpec& part : surface.mixture)
    longest = std::max(longest, longest_of(*part.surface));
  return longest;
}

}  // namespace

double longest_shifted_nm(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                          const materials::MaterialDatabase& database) {
  std::set<std::string> media{spec.ambient.name}, surfaces;
  for (const contact::PlacedMesh& part : placed) {
    if (!part.medium.empty() && part.medium.name != scene_file::kOpaqueMedium) media.insert(part.medium.name);
    surfaces.insert(part.surface.name);
    for (const contact::PlacedFace& face : part.faces) surfaces.insert(face.surface.name);
  }
  for (const scene_file::ContactSpec& contact : spec.contacts) surfaces.insert(contact.surface.name);
  surfaces.erase("");

  double longest = 0.0;
  const auto look_up = [&](const auto& of_definition) {
    try {
      longest = std::max(longest, of_definition());
    } catch (const core::InputError&) {
      // reported where the part is added
    }
  };
  for (const std::string& name : media)
    look_up([&] {
      const optics::Medium& medium = database.medium(name);
      return medium.shifter ? end_of(medium.shifter->emission()) : 0.0;
    });
  for (const std::string& name : surfaces) look_up([&] { return longest_of(database.surface(name)); });
  return longest;
}

}  // namespace scintray::scene
