#pragma once
/// Readers of values that several parts of a surface's definition share.

#include <optional>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/optics/facets.hpp"

namespace scintray::materials {

/// Length in um: the fallback when absent; reported when not positive (or negative, where zero is allowed).
double read_um(const config::TomlTable& table, const std::string& key, double fallback_um, bool zero_allowed);
std::optional<double> read_optional_um(const config::TomlTable& table, const std::string& key);

/// Reports the problems of a file that a key names, at the key, with their places in the file.
void report_of_file(const config::TomlTable& table, const std::string& key, const core::InputError& error);

/// A share, from 0 to 1; required when there is no fallback.
double read_share(const config::TomlTable& table, const std::string& key, std::optional<double> fallback);

/// facets = "projected_area" or "geant4".
optics::FacetSampling read_facet_sampling(const config::TomlTable& table);

/// The keys `sigma_alpha`, `definition`, `facets`, `lobe`, `spike` and `backscatter` of a table: width of the
/// facets' angles and shares of the lobes.
optics::FacetSurface read_facets(const config::TomlTable& table);
/// Roughness of a face that may be smooth, `what`: `sigma_alpha` with the shares of the lobes, or `polish`
/// with `facets`; smooth without either.
optics::FacetSurface read_roughness(const config::TomlTable& table, const char* what);
/// These values, for the key of a table of the surface.
std::string text_of(const optics::FacetSurface& facets);

/// The key `gap`, the index of a thin gap before the reflector of a model that has one of its own; 0: none.
double read_gap_index(const config::TomlTable& table);

/// [tracing] of a surface: settings of its table; nothing for rays traced on the spot.
std::optional<TracingSpec> read_tracing(const config::TomlTable& surface);

}  // namespace scintray::materials
