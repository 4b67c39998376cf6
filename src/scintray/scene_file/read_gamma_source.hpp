#pragma once
/// Reads [source] of the types "gamma_events", "gammas" and "hits" (docs/gamma_sources.md).

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/gamma_spec.hpp"

namespace scintray::scene_file {

/// Values of `source.type` that read_gamma_source reads.
inline const std::vector<std::string> kGammaSourceTypes{"gamma_events", "gammas", "hits"};

/// Reads the keys of the three types from the table [source]; the caller looks at keys of its own, and
/// at what is unknown. Adds what is wrong to the collector of the table.
/// @param source  its `type` is one of kGammaSourceTypes
/// @param parts   names of the scene's parts
GammaSpec read_gamma_source(const config::TomlTable& source, const std::vector<std::string>& parts);

}  // namespace scintray::scene_file
