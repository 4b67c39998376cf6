#include "scintray/scene_file/detail/face_path.hpp"

#include <algorithm>
#include <set>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/names.hpp"
#include "scintray/scene_file/detail/side_faces.hpp"

namespace scintray::scene_file {

namespace {

/// Names, each once, of the possible faces of the parts of this name; nothing when none of them is among
/// `parts`.
std::vector<std::string> faces_of(const std::string& name, const std::vector<PartSpec>& parts) {
  std::vector<std::string> faces;
  for (const PartSpec& part : parts) {
    if (!core::matches_pattern(name, part.name.name)) continue;
    if (faces.empty()) faces.emplace_back(kOtherFaces);
    for (const FaceRuleSpec& rule : part.faces) faces.push_back(rule.name);
    for (std::string& side : side_names(part.shape)) faces.push_back(std::move(side));
    for (const PartSpec& other : parts)
      if (other.priority > part.priority) faces.push_back(contact::kCutFaces + other.name.name);
  }
  std::set<std::string> seen;
  std::erase_if(faces, [&seen](const std::string& face) { return !seen.insert(face).second; });
  return faces;
}

}  // namespace

std::optional<FacePath> read_face_path(const config::TomlTable& table, const std::string& key,
                                       const std::string& text, const std::vector<std::string>& names,
                                       const std::vector<PartSpec>& parts, bool wildcards) {
  const auto colon = text.find(':');
  table.expect(key, colon != std::string::npos && colon > 0 && colon + 1 < text.size(),
               "\"" + text + "\" is not the name of a face", "write \"part:face\", as \"crystal:exit\"");
  if (!table.good(key)) return std::nullopt;
  const FacePath path{{text.substr(0, colon), table.where(key)}, {text.substr(colon + 1), table.where(key)}};
  (wildcards ? expect_parts : expect_part)(table, key, path.part, names);
  if (!table.good(key)) return std::nullopt;
  const std::vector<std::string> faces = faces_of(path.part.name, parts);
  if (faces.empty()) return path;
  const std::string near = core::nearest_word(path.face.name, faces);
  table.expect(key, std::find(faces.begin(), faces.end(), path.face.name) != faces.end(),
               "the part \"" + path.part.name + "\" has no face \"" + path.face.name + "\"",
               (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "its faces are " +
                   core::list_of(faces) + "; name more of them with [[part.face]]");
  if (!table.good(key)) return std::nullopt;
  return path;
}

}  // namespace scintray::scene_file
