#pragma once
/// Sweeps: one scene file, many scenes.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"

namespace scintray::scene_file {

/// A key of a scene file that is set by a sweep or a fit, and the keys set with it.
struct KeyPath {
  std::string key;                 ///< dotted path, "source.region.slab_z.center"
  std::vector<std::string> also;   ///< keys set to the same value
  core::FileLocation where;        ///< of the text that names the key
  std::string role = "swept key";  ///< of the key, for messages
};

/// [[sweep]]: the values of a key, in order.
struct SweepSpec {
  KeyPath path;
  std::string label;  ///< heading; the key by default
  std::vector<config::TomlNode> values;
};

/// A key and its value.
struct KeySetting {
  KeyPath path;
  config::TomlNode value;
};

/// The sweeps of a scene, slowest first. Faulty ones are reported and omitted.
std::vector<SweepSpec> read_sweeps(const config::TomlTable& scene);

/// False for keys of the run as a whole, which cannot differ between the points of a sweep.
bool may_be_set(const std::string& key);

/// A copy of the document in which the keys at the paths have the given value, which keeps its own place in
/// the file so that errors refer to its definition (a sweep, a fit).
///
/// Entries of an array of tables are addressed by their `name`: "part.crystal.surface",
/// "part.crystal.face.exit.surface", the shares of a mixture by their `surface`:
/// "surfaces.wrapped.mixture.glued.share". Elements of an array of three are x, y and z: "source.position.z".
/// "slab_z.center" moves a slab and keeps its thickness. A path that does not exist is added to `problems`,
/// and the document is returned unchanged.
config::TomlNode with_value(const config::TomlNode& document, const KeySetting& setting,
                            core::Problems& problems);

}  // namespace scintray::scene_file
