#pragma once
/// Names and counts in the tables of a scene file.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"

namespace scintray::scene_file {

/// A name, with its place; empty when absent and not required.
config::NameRef read_name(const config::TomlTable& table, const std::string& key, bool required);

/// One name or a list of them, each with its place; none when absent and not required.
std::vector<config::NameRef> read_names(const config::TomlTable& table, const std::string& key,
                                        bool required);

/// Reports a new name with reserved characters.
void expect_plain_name(const config::TomlTable& table, const std::string& key, const std::string& name);

/// Reports at `key` a name that is not that of a part. No report when no name is available.
void expect_part(const config::TomlTable& table, const std::string& key, const config::NameRef& name,
                 const std::vector<std::string>& parts);

/// The same for a name that may have wildcards, which must match one part at least.
void expect_parts(const config::TomlTable& table, const std::string& key, const config::NameRef& pattern,
                  const std::vector<std::string>& parts);

/// The value of an integer key, from 1 to 1e15; another is reported, and a value below 1 replaced by 1.
std::uint64_t positive_count(const config::TomlTable& table, const std::string& key, std::int64_t value);

}  // namespace scintray::scene_file
