#pragma once
/// The forms of the material, sensor and reflector files (docs/materials.md).

#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/materials/sensor_models.hpp"
#include "scintray/materials/source_rule.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/reflector.hpp"

namespace scintray::materials {

/// Step at which dispersion formulae are tabulated, nm: linear interpolation is then within 1e-5 of the
/// formula for every shipped medium (tests/materials; at 2 nm BGO would miss that at 350 nm).
inline constexpr double kFormulaStep_nm = 1.0;

/// Each reads one definition from its outermost table, and adds what is wrong to the collector of the
/// table. The result may be used only when nothing was. The caller calls `table.finish()`.
optics::Medium read_medium(const config::TomlTable& table, const std::string& name, SourceRule rule);
detector::Sensor read_sensor(const config::TomlTable& table, const std::string& name, SourceRule rule,
                             const SensorModels& models = {});
optics::Reflector read_reflector(const config::TomlTable& table, const std::string& name, SourceRule rule);

/// Reports at `key`, the transmittance, a sheet that re-emits and lets through more than it gets.
void expect_sheet(const config::TomlTable& table, const std::string& key, const optics::Reflector& reflector);

/// Reads what something is made of from `formula` or `mass_fractions`; empty when wrong.
optics::Composition read_composition(const config::TomlTable& block);

}  // namespace scintray::materials
