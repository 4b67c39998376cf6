#pragma once
/// The pieces of read_scene, one for each kind of table.

#include <optional>
#include <string>
#include <vector>

#include "scintray/scene_file/spec.hpp"

namespace scintray::scene_file {

/// A string that names something, with its place; empty when absent and not required.
config::NameRef read_name(const config::TomlTable& table, const std::string& key, bool required);

/// Reports a new name that holds characters with a meaning elsewhere.
void expect_plain_name(const config::TomlTable& table, const std::string& key, const std::string& name);

/// "-x" to "+z" as a side; nothing for other words.
std::optional<BoxSide> side_of(const std::string& word);

/// The keys of a [[part]] or of an element, but for its name and place: shape, medium, sensor,
/// surface and faces.
void read_body(const config::TomlTable& table, PartSpec& part);

/// rotate, place and translate; `earlier` are the names that may be touched.
PlacementSpec read_placement(const config::TomlTable& table, const std::vector<std::string>& earlier);

/// rotate, one table or a list.
std::vector<RotationSpec> read_rotations(const config::TomlTable& part);

/// [[face]] of a part, an element or an override.
std::vector<FaceRuleSpec> read_faces(const config::TomlTable& part);

/// Everything with a body: [[part]], [[array]], [[light_guide]], in file order.
struct Bodies {
  std::vector<PartSpec> parts;
  std::vector<GroupSpec> groups;
  std::vector<ContactSpec> contacts;  ///< that builders make with their parts
  InlineTables surfaces;              ///< that builders make for their sheets
  bool names_known = true;            ///< false when mistakes left a builder's parts unknown
};

/// Reads all bodies and checks their names against each other.
Bodies read_bodies(const config::TomlTable& scene);

/// Names of all parts, the fills that placements make included, in file order.
std::vector<std::string> part_names(const std::vector<PartSpec>& parts, const std::vector<GroupSpec>& groups);

/// Reports at `key` unless the name is one of a part. Says nothing when no name is known.
void expect_part(const config::TomlTable& table, const std::string& key, const config::NameRef& name,
                 const std::vector<std::string>& parts);

/// What "bonded" and "dry" stand for.
ContactKind contact_kind(const std::string& word);

/// The same for a name that may have wildcards and then must be that of one part at least.
void expect_parts(const config::TomlTable& table, const std::string& key, const config::NameRef& pattern,
                  const std::vector<std::string>& parts);

/// [[contact]].
std::vector<ContactSpec> read_contacts(const config::TomlTable& scene,
                                       const std::vector<std::string>& part_names,
                                       const std::vector<PartSpec>& parts);

/// [source], of any type, into `spec`.
void read_source(const config::TomlTable& scene, const std::vector<std::string>& parts, SceneSpec& spec);

/// The value of `source.region`.
RegionSpec read_region(const config::TomlTable& table, const std::vector<std::string>& parts);

/// `direction`: "isotropic", a beam, a cone or a Lambertian lobe.
DirectionSpec read_direction(const config::TomlTable& table);

/// The value of an integer key, reported and 1 when it is below 1.
std::uint64_t positive_count(const config::TomlTable& table, const std::string& key, std::int64_t value);

/// [run].
RunSpec read_run(const config::TomlTable& scene);

/// [[tally]]: fills scene.exit_angles and scene.tallies, names checked against scene.parts.
void read_tallies(const config::TomlTable& table, SceneSpec& scene);

}  // namespace scintray::scene_file
