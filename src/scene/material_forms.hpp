#pragma once
/// The forms of the material, sensor and reflector files (docs/materials.md).

#include <string>
#include <vector>

#include "scintray/detector/sensor.hpp"
#include "scintray/medium/medium.hpp"
#include "scintray/scene/toml_reader.hpp"
#include "scintray/surface/surface.hpp"

namespace scintray {

/// Whether every number must say where it was published: always in the library's files, by choice in
/// a scene's own definitions.
enum class SourceRule { required, optional };

/// Step at which dispersion formulae are tabulated, nm: linear interpolation is then within 1e-5 of the
/// formula for every shipped medium (tests/materials; at 2 nm BGO would miss that at 350 nm).
inline constexpr double kFormulaStep_nm = 1.0;

/// Each reads one definition from its outermost table, and adds what is wrong to the collector of the
/// table. The result may be used only when nothing was. The caller calls `table.finish()`.
Medium read_medium(const TomlTable& table, const std::string& name, SourceRule rule);
Sensor read_sensor(const TomlTable& table, const std::string& name, SourceRule rule);
Reflector read_reflector(const TomlTable& table, const std::string& name, SourceRule rule);

/// Reports at `key`, the transmittance, a sheet that gives back and lets through more than it gets.
void expect_sheet(const TomlTable& table, const std::string& key, const Reflector& reflector);

/// Reads what something is made of from `formula` or `mass_fractions`; empty when wrong.
Composition read_composition(const TomlTable& block);

/// Reads `source` from a block and appends "BLOCK: source" to `sources`.
void read_source(const TomlTable& block, SourceRule rule, std::vector<std::string>& sources);

}  // namespace scintray
