#pragma once
/// What the forms of the material, sensor and surface files share (docs/materials.md).

#include <functional>
#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/materials/sensor_models.hpp"
#include "scintray/materials/source_rule.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::materials {

/// Reads how the light of a scintillator depends on energy, beyond its yield: [non_proportionality] and
/// [intrinsic_resolution] of a medium, where they are given. Adds what is wrong to the collector of the
/// table.
void read_light_response(const config::TomlTable& table, SourceRule rule, optics::Medium& medium);
/// Reports them in a medium that does not scintillate.
void refuse_light_response(const config::TomlTable& table);

/// Largest refractive index that is not taken for a mistake.
inline constexpr double kGreatestIndex = 5.0;

inline constexpr core::Word<detector::EfficiencyDefinition> kEfficiencyDefinitions[] = {
    {"internal", detector::EfficiencyDefinition::internal},
    {"external", detector::EfficiencyDefinition::external}};

/// Reports unless a curve stays within 0 and 1.
void expect_share(const config::TomlTable& block, const std::string& key, const core::Curve& curve,
                  const std::string& what);

/// Looks up what a surface names; all throw InputError at `where` when there is nothing of the name.
struct SurfaceLookup {
  std::function<optics::Medium(const std::string& name, const core::FileLocation& where)> medium;
  std::function<SurfaceSpec(const std::string& name, const core::FileLocation& where)> surface;
  std::function<optics::Reflector(const std::string& name, const core::FileLocation& where)> reflector;
  const SurfaceModels& models;
};

/// A definition laid over its base: keys of `over` win, tables are merged key by key. A model of its
/// own drops the base's table of another model, and `reflector` and `reflectance` drop each other.
config::TomlNode merge_over_base(const config::TomlNode& base, const config::TomlNode& over,
                                 const SurfaceModels& models);

/// What the presets in a definition leave to the user (`needs`) and is not given.
std::vector<std::string> missing_needs(const config::TomlNode& definition);

/// Reads a merged definition; problems go to the collector of the table.
SurfaceSpec read_surface(const config::TomlTable& table, const std::string& name, const SurfaceLookup& lookup,
                         core::Problems& problems);

}  // namespace scintray::materials
