#pragma once
/// How the light of a scintillator depends on energy, beyond its yield: [non_proportionality] and
/// [intrinsic_resolution] of a medium (docs/materials.md).

#include "scintray/materials/material_forms.hpp"

namespace scintray::materials {

/// Reads both, where they are given. Adds what is wrong to the collector of the table.
void read_light_response(const config::TomlTable& table, SourceRule rule, optics::Medium& medium);

/// Reports them in a medium that does not scintillate.
void refuse_light_response(const config::TomlTable& table);

}  // namespace scintray::materials
