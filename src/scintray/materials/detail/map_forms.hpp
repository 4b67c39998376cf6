#pragma once
/// The tables [height_map] and [recipe] of a surface, as far as they say how its relief is prepared
/// or made.

#include "scintray/config/toml_reader.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::materials {

/// A length in um: the fallback when absent; reported when not positive (or negative, where zero is
/// allowed).
double read_um(const config::TomlTable& table, const std::string& key, double fallback_um, bool zero_allowed);
std::optional<double> read_optional_um(const config::TomlTable& table, const std::string& key);

/// Cropping, outliers, filling, filters and levelling.
topography::Preparation read_preparation(const config::TomlTable& height_map);

/// The relief of a recipe, with its grid and seed.
topography::SynthesisRecipe read_synthesis(const config::TomlTable& recipe);

}  // namespace scintray::materials
