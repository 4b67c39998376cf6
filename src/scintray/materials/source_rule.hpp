#pragma once
/// Where the numbers of a definition were published.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"

namespace scintray::materials {

/// Whether every number must state where it was published: always in the database's files, by choice in
/// a scene's own definitions.
enum class SourceRule { required, optional };

/// Reads `source` from a block and appends "BLOCK: source" to `sources`.
void read_source(const config::TomlTable& block, SourceRule rule, std::vector<std::string>& sources);

}  // namespace scintray::materials
