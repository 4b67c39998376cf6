#pragma once
/// Common parts of the forms of material, sensor and surface files (docs/materials.md).

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

/// Reads the dependence of a scintillator's light on energy, beyond its yield: the optional
/// [non_proportionality] and [intrinsic_resolution] of a medium. Adds errors to the collector of the table.
void read_light_response(const config::TomlTable& table, SourceRule rule, optics::Medium& medium);
/// Reports these tables in a medium that does not scintillate.
void refuse_light_response(const config::TomlTable& table);

/// Largest refractive index that is accepted.
inline constexpr double kGreatestIndex = 5.0;

inline constexpr core::Word<detector::EfficiencyDefinition> kEfficiencyDefinitions[] = {
    {"internal", detector::EfficiencyDefinition::internal},
    {"external", detector::EfficiencyDefinition::external}};

/// Reports unless a curve stays within 0 and 1.
void expect_share(const config::TomlTable& block, const std::string& key, const core::Curve& curve,
                  const std::string& what);

/// Look-up of the definitions named by a surface; all throw InputError at `where` for an unknown name.
struct SurfaceLookup {
  std::function<optics::Medium(const std::string& name, const core::FileLocation& where)> medium;
  std::function<SurfaceSpec(const std::string& name, const core::FileLocation& where)> surface;
  std::function<optics::Reflector(const std::string& name, const core::FileLocation& where)> reflector;
  const SurfaceModels& models;
};

/// A definition merged over its base: keys of `over` take precedence, tables are merged key by key. A model
/// of its own removes the base's table of another model, and `reflector` and `reflectance` replace each
/// other.
config::TomlNode merge_over_base(const config::TomlNode& base, const config::TomlNode& over,
                                 const SurfaceModels& models);

/// Keys that the presets in a definition require from the user (`needs`) and that are missing.
std::vector<std::string> missing_needs(const config::TomlNode& definition);

/// Surface of a merged definition; problems are added to the collector of the table.
SurfaceSpec read_surface(const config::TomlTable& table, const std::string& name, const SurfaceLookup& lookup,
                         core::Problems& problems);

}  // namespace scintray::materials
