#pragma once
/// Sweeps: one scene file, many scenes.

#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray {

/// [[sweep]]: the values a key takes, one after the other.
struct SweepSpec {
  std::string key;                ///< dotted path, "source.region.slab_z.center"
  std::string label;              ///< heading; the key when not given
  std::vector<std::string> also;  ///< keys that take the same value
  std::vector<TomlNode> values;
  FileLocation where;  ///< of the key's value
};

/// The sweeps of a scene, slowest first. What is wrong is reported, and left out.
std::vector<SweepSpec> read_sweeps(const TomlTable& scene);

/// A copy of the document in which the keys at a sweep's paths have the given value, which keeps its
/// own place in the file so that errors point at the sweep.
///
/// Entries of an array of tables are addressed by their `name`: "part.crystal.surface",
/// "part.crystal.face.exit.surface". Elements of an array of three are x, y and z:
/// "source.position.z". "slab_z.center" moves a slab and keeps its thickness.
/// A path that leads nowhere is added to `problems`, and the document returned as it was.
TomlNode with_value(const TomlNode& document, const SweepSpec& sweep, const TomlNode& value,
                    Problems& problems);

}  // namespace scintray
