#pragma once
/// The form of the surface files (docs/materials.md).

#include <functional>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::materials {

/// Looks up what a surface names; all throw InputError at `where` when there is nothing of the name.
struct SurfaceLookup {
  std::function<optics::Medium(const std::string& name, const core::FileLocation& where)> medium;
  std::function<SurfaceSpec(const std::string& name, const core::FileLocation& where)> surface;
  std::function<optics::Reflector(const std::string& name, const core::FileLocation& where)> reflector;
};

/// A definition laid over its base: keys of `over` win, tables are merged key by key. A model of its
/// own drops the base's table of another model, and `reflector` and `reflectance` drop each other.
config::TomlNode merge_over_base(const config::TomlNode& base, const config::TomlNode& over);

/// What the presets in a definition leave to the user (`needs`) and is not given.
std::vector<std::string> missing_needs(const config::TomlNode& definition);

/// Reads a merged definition; problems go to the collector of the table.
SurfaceSpec read_surface(const config::TomlTable& table, const std::string& name, const SurfaceLookup& lookup,
                         core::Problems& problems);

}  // namespace scintray::materials
