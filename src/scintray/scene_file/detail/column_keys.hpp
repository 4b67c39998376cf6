#pragma once
/// Keys of sources whose rows another program wrote.

#include <filesystem>
#include <string>

#include "scintray/config/toml_reader.hpp"

namespace scintray::scene_file {

/// Value of a unit in internal units; reported when it is not a unit.
double read_unit(const config::TomlTable& table, const std::string& key, core::Dimension dimension);

/// The key `group` beside a file of columns; reports a file of another format, and a group of one without
/// groups.
/// @param rows  kind of the rows: "hits"
std::string read_column_group(const config::TomlTable& table, const std::filesystem::path& file,
                              const std::string& rows);

}  // namespace scintray::scene_file
