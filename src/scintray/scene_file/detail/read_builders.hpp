#pragma once
/// Reading [[array]] and [[light_guide]].

#include <string>
#include <vector>

#include "scintray/scene_file/detail/builder_spec.hpp"

namespace scintray::scene_file {

/// One [[array]]. `earlier` are the names that it may touch; `surfaces` receives the surfaces of sheets that
/// are given by their reflector.
ArraySpec read_array(const config::TomlTable& table, const std::vector<std::string>& earlier,
                     InlineTables& surfaces);

/// One [[light_guide]].
LightGuideSpec read_light_guide(const config::TomlTable& table, const std::vector<std::string>& earlier,
                                InlineTables& surfaces);

/// What sheets are made of: "medium", "surface" or "reflector", "contact".
SheetSpec read_sheet(const config::TomlTable& table, InlineTables& surfaces);

/// Two whole numbers from 1 to 10000; {1, 1} when wrong or absent.
std::array<int, 2> read_count(const config::TomlTable& table, const std::string& key);

/// A length for both x and y, or two; nothing when absent or wrong.
std::optional<std::array<double, 2>> read_length_pair(const config::TomlTable& table, const std::string& key);

/// More parts than this in one builder are surely a mistake.
inline constexpr std::size_t kMostParts = 200000;

}  // namespace scintray::scene_file
