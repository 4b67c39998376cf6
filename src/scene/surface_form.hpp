#pragma once
/// The form of the surface files (docs/materials.md).

#include <functional>
#include <string>

#include "scintray/medium/medium.hpp"
#include "scintray/scene/surface_spec.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray {

/// Looks up what a surface names; all throw InputError at `where` when there is nothing of the name.
struct SurfaceLookup {
  std::function<Medium(const std::string& name, const FileLocation& where)> medium;
  std::function<SurfaceSpec(const std::string& name, const FileLocation& where)> surface;
  std::function<Reflector(const std::string& name, const FileLocation& where)> reflector;
};

/// A definition laid over its base: keys of `over` win, tables are merged key by key. A model of its
/// own drops the base's table of another model, and `reflector` and `reflectance` drop each other.
TomlNode merge_over_base(const TomlNode& base, const TomlNode& over);

/// What the presets in a definition leave to the user (`needs`) and is not given.
std::vector<std::string> unmet_needs(const TomlNode& definition);

/// Reads a merged definition; problems go to the collector of the table.
SurfaceSpec read_surface(const TomlTable& table, const std::string& name, const SurfaceLookup& lookup,
                         Problems& problems);

}  // namespace scintray
