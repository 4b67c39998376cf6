#pragma once
/// Published sources of the numbers of a definition.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"

namespace scintray::materials {

/// Requirement of a published source for every number: required in the database's files, optional in a
/// scene's own definitions.
enum class SourceRule { required, optional };

/// Reads `source` from a block and appends "BLOCK: source" to `sources`.
void read_source(const config::TomlTable& block, SourceRule rule, std::vector<std::string>& sources);

}  // namespace scintray::materials
