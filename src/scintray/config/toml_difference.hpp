#pragma once
/// Whether two scene files say the same.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"

namespace scintray::config {

/// Path of the first key that only one document has or whose values differ as written, like
/// "part.crystal.surface"; empty when there is none. The order of keys does not matter, that of arrays does.
/// @param besides  keys of the outermost table that do not count, with all in them
std::string first_difference(const TomlNode& a, const TomlNode& b, const std::vector<std::string>& besides);

}  // namespace scintray::config
