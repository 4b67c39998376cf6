#pragma once
/// Common parts of the forms of material, sensor and surface files (docs/materials.md).

#include <functional>
#include <memory>
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

/// Reads how a medium scintillates: the optional [yield], [emission] and [[decay]], which come together, with
/// what read_light_response reads.
void read_scintillation(const config::TomlTable& table, SourceRule rule, optics::Medium& medium);
/// An emission spectrum, relative photon number per nm against wavelength (nm), from `spectrum`.
core::Curve read_emission(const config::TomlTable& block);
/// The components of `decay`, whose fractions must sum to 1; empty when absent.
std::vector<optics::DecayComponent> read_decay(const config::TomlTable& table, SourceRule rule,
                                               std::vector<std::string>& sources);
/// A refractive index against wavelength (nm) from `n`, `sellmeier` or `cauchy`.
core::Curve read_index(const config::TomlTable& block);
/// A group index, as measured, from `group`; nothing when absent.
std::optional<core::Curve> read_group_index(const config::TomlTable& block);
/// Reports unless every wavelength of a table is positive.
void expect_wavelengths(const config::TomlTable& block, const std::string& key, const core::Curve& curve);
/// Reads the `y` and `z` of [index] and [absorption], which make a medium birefringent, and sets its means;
/// without any the medium stays as it is.
void read_birefringence(const config::TomlTable& index, const config::TomlTable& absorption,
                        optics::Medium& medium);
/// A coefficient per mm against wavelength (nm) from `length`, `coefficient`, or `none = true`.
core::Curve read_extinction(const config::TomlTable& block);
/// The wavelength shifters of a medium, [wavelength_shifting] or several [[wavelength_shifting]], in which
/// every block states its own source. Null when there are none, or a problem.
std::shared_ptr<const optics::WavelengthShifter> read_shifter(const config::TomlTable& medium,
                                                              SourceRule rule,
                                                              std::vector<std::string>& sources);

/// Largest refractive index that is accepted.
inline constexpr double kGreatestIndex = 5.0;

inline constexpr core::Word<detector::EfficiencyDefinition> kEfficiencyDefinitions[] = {
    {"internal", detector::EfficiencyDefinition::internal},
    {"external", detector::EfficiencyDefinition::external},
    {"absorbed", detector::EfficiencyDefinition::absorbed}};

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
