#pragma once
/// The pieces of read_scene, one for each kind of table.

#include <set>
#include <string>
#include <vector>

#include "scintray/scene/spec.hpp"

namespace scintray {

/// A string that names something, with its place; empty when absent and not required.
NameRef read_name(const TomlTable& table, const std::string& key, bool required);

/// { low = [...], high = [...] } under `key`; nothing when absent or wrong.
std::optional<BoxSpec> read_low_high(const TomlTable& table, const std::string& key);

/// [[part]], with the names checked against each other.
std::vector<PartSpec> read_parts(const TomlTable& scene);

/// Names of all parts, the fills that placements make included, in file order.
std::vector<std::string> part_names(const std::vector<PartSpec>& parts);

/// Reports at `key` unless the name is one of a part.
void expect_part(const TomlTable& table, const std::string& key, const NameRef& name,
                 const std::vector<std::string>& parts);

/// The same for a name that may have wildcards and then must be that of one part at least.
void expect_parts(const TomlTable& table, const std::string& key, const NameRef& pattern,
                  const std::vector<std::string>& parts);

/// [[contact]].
std::vector<ContactSpec> read_contacts(const TomlTable& scene, const std::vector<std::string>& parts);

/// [source].
SourceSpec read_source(const TomlTable& scene, const std::vector<std::string>& parts);

/// The value of `source.region`.
RegionSpec read_region(const TomlTable& table, const std::vector<std::string>& parts);

/// `direction`: "isotropic", a beam, a cone or a Lambertian lobe.
DirectionSpec read_direction(const TomlTable& table);

/// The value of an integer key, reported and 1 when it is below 1.
std::uint64_t positive_count(const TomlTable& table, const std::string& key, std::int64_t value);

/// [run].
RunSpec read_run(const TomlTable& scene);

/// [[tally]]: fills scene.exit_angles and scene.tallies, names checked against scene.parts.
void read_tallies(const TomlTable& table, SceneSpec& scene);

}  // namespace scintray
