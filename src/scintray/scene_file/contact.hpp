#pragma once
/// [[contact]]: what is between faces that touch. Lengths mm.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// How the touching faces of two parts meet.
enum class ContactKind {
  bonded,  ///< optical contact: one interface between both media
  dry,     ///< an air gap of no thickness: each side keeps its surface to the ambient medium
};

inline constexpr core::Word<ContactKind> kContactKinds[] = {{"bonded", ContactKind::bonded},
                                                            {"dry", ContactKind::dry}};

struct ContactSpec {
  std::array<config::NameRef, 2> between;  ///< names, or patterns with "*" (core/pattern.hpp)
  std::array<std::string, 2> faces;        ///< of the two parts; empty: every face
  ContactKind kind = ContactKind::bonded;
  config::NameRef surface;  ///< of the shared interface; empty: the surfaces of the two faces decide
  bool joint = false;       ///< bonded within one body: smooth, whatever the faces' surfaces are
  bool by_builder = false;  ///< made with a builder's parts: yields to what the file states, may find no pair
  /// Faces this near to each other, curved ones too, are made one (contact/neighbours.hpp); nothing: only
  /// those within the scene's contact tolerance.
  std::optional<double> tolerance_mm;
  core::FileLocation where;
};

/// [[contact]] of a scene; `part_names` are those of all parts, `parts` those whose faces are known.
std::vector<ContactSpec> read_contacts(const config::TomlTable& scene,
                                       const std::vector<std::string>& part_names,
                                       const std::vector<PartSpec>& parts);

}  // namespace scintray::scene_file
