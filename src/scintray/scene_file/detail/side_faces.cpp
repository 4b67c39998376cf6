#include "scintray/scene_file/detail/side_faces.hpp"

#include <algorithm>
#include <type_traits>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/pattern.hpp"

namespace scintray::scene_file {

namespace {

std::vector<std::string> numbered_sides(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("side" + std::to_string(i));
  return names;
}

/// Adds a side to the parts that match, unless they have a face of that name.
void name_side(const std::string& part_pattern, const std::string& face, std::vector<PartSpec>& parts) {
  if (face.empty() || face == kOtherFaces || core::is_pattern(face) || face.starts_with(contact::kCutFaces))
    return;
  for (PartSpec& part : parts) {
    if (!core::matches_pattern(part_pattern, part.name.name)) continue;
    const bool known = std::any_of(part.faces.begin(), part.faces.end(),
                                   [&face](const FaceRuleSpec& rule) { return rule.name == face; });
    if (known) continue;
    FaceRuleSpec side;
    side.name = face;
    side.select.group.name = face;
    part.faces.push_back(std::move(side));
  }
}

}  // namespace

std::vector<std::string> side_names(const ShapeSpec& shape) {
  return std::visit(
      [](const auto& spec) -> std::vector<std::string> {
        using Spec = std::decay_t<decltype(spec)>;
        if constexpr (std::is_same_v<Spec, BoxSpec> || std::is_same_v<Spec, TaperedSpec>)
          return {"-x", "+x", "-y", "+y", "-z", "+z"};
        else if constexpr (std::is_same_v<Spec, WinstonSpec>)
          return {"side", "-x", "+x", "-y", "+y", "-z", "+z"};
        else if constexpr (std::is_same_v<Spec, CylinderSpec> || std::is_same_v<Spec, ConeSpec> ||
                           std::is_same_v<Spec, LensSpec>)
          return {"side", "-z", "+z"};
        else if constexpr (std::is_same_v<Spec, SphereSpec>)
          return {"sphere"};
        else if constexpr (std::is_same_v<Spec, SpheroidSpec>)
          return {"spheroid"};
        else if constexpr (std::is_same_v<Spec, TorusSpec>)
          return {"torus"};
        else if constexpr (std::is_same_v<Spec, TubeSpec>)
          return {"side", "bore", "-z", "+z"};
        else if constexpr (std::is_same_v<Spec, FibreSpec>)
          return spec.shape.radius > 0.0
                     ? std::vector<std::string>{"side", "start", "end"}
                     : std::vector<std::string>{"side0", "side1", "side2", "side3", "start", "end"};
        else if constexpr (std::is_same_v<Spec, RevolvedSpec>)
          return numbered_sides(spec.profile.size());
        else if constexpr (std::is_same_v<Spec, PrismSpec>) {
          std::vector<std::string> names = numbered_sides(static_cast<std::size_t>(std::max(spec.sides, 0)));
          names.insert(names.end(), {"-z", "+z"});
          return names;
        } else
          return {};
      },
      shape);
}

void name_sides(SceneSpec& scene) {
  for (const TallySpec& tally : scene.tallies)
    for (const config::NameRef& face : tally.faces)
      if (const std::size_t colon = face.name.find(':'); colon != std::string::npos)
        name_side(face.name.substr(0, colon), face.name.substr(colon + 1), scene.parts);
  for (const ContactSpec& contact : scene.contacts)
    for (std::size_t side = 0; side < 2; ++side)
      name_side(contact.between[side].name, contact.faces[side], scene.parts);
}

}  // namespace scintray::scene_file
