#pragma once
/// How the light of a scintillator depends on energy, beyond its yield: [non_proportionality] and
/// [intrinsic_resolution] of a medium (docs/materials.md).

#include "scintray/scene/material_forms.hpp"

namespace scintray {

/// Reads both, where they are given. Adds what is wrong to the collector of the table.
void read_light_response(const TomlTable& table, SourceRule rule, Medium& medium);

/// Reports them in a medium that does not scintillate.
void refuse_light_response(const TomlTable& table);

}  // namespace scintray
