#pragma once
/// [[contact]]: the optical contact between faces that touch; [[gap]]: small gaps that are intended. Lengths
/// mm.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// Kind of contact between the touching faces of two parts.
enum class ContactKind {
  bonded,  ///< optical contact: one interface between both media
  dry,     ///< a gap of no thickness: each face keeps its surface to the ambient medium
  /// Optical contact in which light that leaves a part interacts with that part's surface alone, and with the
  /// other part's where the part that it leaves has none (Geant4's rule for skin surfaces).
  each_side,
};

inline constexpr core::Word<ContactKind> kContactKinds[] = {
    {"bonded", ContactKind::bonded}, {"dry", ContactKind::dry}, {"each_side", ContactKind::each_side}};

struct ContactSpec {
  std::array<config::NameRef, 2> between;  ///< names, or patterns with "*" (core/pattern.hpp)
  std::array<std::string, 2> faces;        ///< of the two parts; empty: every face
  ContactKind kind = ContactKind::bonded;
  config::NameRef surface;  ///< of the shared interface; empty: from the surfaces of the two faces
  /// Of a contact of kind each_side: surfaces for light from the first part and from the second (Geant4's
  /// border surfaces); empty: as without them.
  std::array<config::NameRef, 2> leaving;
  bool joint = false;  ///< bonded within one body: smooth, independent of the faces' surfaces
  bool by_builder =
      false;  ///< made with a builder's parts: contacts of the file precede it; may match no pair
  /// Distance within which faces, curved ones included, are made one (contact/neighbours.hpp); nothing: the
  /// scene's contact tolerance.
  std::optional<double> tolerance_mm;
  core::FileLocation where;
  bool operator==(const ContactSpec&) const = default;
};

/// Parts between which small gaps are intended: `check` counts them without a warning.
struct GapSpec {
  std::array<config::NameRef, 2> between;  ///< names, or patterns with "*" (core/pattern.hpp)
  core::FileLocation where;
  bool operator==(const GapSpec&) const = default;
};

/// [[gap]] of a scene; `part_names` are those of all parts.
std::vector<GapSpec> read_gaps(const config::TomlTable& scene, const std::vector<std::string>& part_names);

/// [[contact]] of a scene; `part_names` are those of all parts, `parts` those with known faces.
std::vector<ContactSpec> read_contacts(const config::TomlTable& scene,
                                       const std::vector<std::string>& part_names,
                                       const std::vector<PartSpec>& parts);

}  // namespace scintray::scene_file
