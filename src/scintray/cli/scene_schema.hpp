#pragma once
/// The keys of scene files for editors and readers, from the code that reads them (config/schema.hpp).

#include <string>
#include <vector>

#include "scintray/config/schema.hpp"

namespace scintray::cli {

/// All tables of a scene: its own, and those of its definitions as "media.NAME" and the like.
std::vector<config::TableSchema> scene_tables();

/// JSON Schema (draft 2020-12) of scenes. It accepts every scene that is read without an error; of errors it
/// refuses unknown keys, absent keys that are always needed, values of another type, quantities without a
/// unit or with one of another dimension, words that are not among those allowed, and keys that exclude each
/// other.
std::string json_schema(const std::vector<config::TableSchema>& tables);

/// A page in Markdown: each table with its keys, what they accept, their defaults and the conditions on them.
std::string key_reference(const std::vector<config::TableSchema>& tables);

}  // namespace scintray::cli
