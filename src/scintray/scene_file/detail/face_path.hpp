#pragma once
/// "part:face" in a scene file.

#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// A part and one of its faces.
struct FacePath {
  config::NameRef part, face;
};

/// Part and face of `text`, the value or an element of `key`, separated at its first colon; the part may have
/// wildcards when `wildcards`. `names` are all parts of the scene, `parts` those with known faces. Errors are
/// reported at the key: no colon, an unknown part, a face that no such part has.
std::optional<FacePath> read_face_path(const config::TomlTable& table, const std::string& key,
                                       const std::string& text, const std::vector<std::string>& names,
                                       const std::vector<PartSpec>& parts, bool wildcards);

}  // namespace scintray::scene_file
