#pragma once
/// The forms of the material, sensor and reflector files (docs/materials.md).

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/materials/sensor_models.hpp"
#include "scintray/materials/source_rule.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/reflector.hpp"

namespace scintray::materials {

/// Step at which dispersion formulae are tabulated, nm: linear interpolation is then within 1e-5 of the
/// formula for every shipped medium (tests/materials; at 2 nm BGO exceeds that at 350 nm).
inline constexpr double kFormulaStep_nm = 1.0;

/// The definition in an outermost table, of a medium, sensor or reflector. Errors are added to the collector
/// of the table; the result may be used only without any. The caller calls `table.finish()`.
optics::Medium read_medium(const config::TomlTable& table, const std::string& name, SourceRule rule);
detector::Sensor read_sensor(const config::TomlTable& table, const std::string& name, SourceRule rule,
                             const SensorModels& models = {});
optics::Reflector read_reflector(const config::TomlTable& table, const std::string& name, SourceRule rule);

/// Reports at `key`, the transmittance, a sheet whose reflectance and transmittance sum to more than 1.
void expect_sheet(const config::TomlTable& table, const std::string& key, const optics::Reflector& reflector);

/// Composition from `formula` or `mass_fractions`; empty on an error.
optics::Composition read_composition(const config::TomlTable& block);

/// How the reader of a definition uses its keys, errors and all (config::explore_keys).
/// @param tables  the table of definitions in a scene: "media", "surfaces", "sensors" or "reflectors"
std::vector<config::KeyUse> definition_key_uses(const std::string& tables,
                                                const config::TomlNodePtr& definition);

}  // namespace scintray::materials
