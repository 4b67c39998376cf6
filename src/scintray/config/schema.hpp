#pragma once
/// The keys that a reader of TOML accepts, the accepted forms of each, and the keys on which it depends:
/// determined by running the reader.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"

namespace scintray::config {

/// One key of a table, as a reader uses it.
struct KeySchema {
  std::string key;
  std::vector<KeyUse> forms;       ///< what is accepted; each form once
  std::vector<std::string> rules;  ///< messages of the conditions on the value
  std::string fallback;            ///< the value of an absent key, as text; empty: none, or not a constant
  bool required = false;           ///< wherever its table is read
  std::vector<std::string>
      beside;  ///< keys and values required for it to be read, as `source.type = "photons"`
};

/// One table.
struct TableSchema {
  std::string path;                              ///< "part.face"; empty for the outermost table
  std::vector<KeySchema> keys;                   ///< in the order of reading
  std::vector<std::vector<std::string>> one_of;  ///< groups of keys of which each excludes the others, always
  std::vector<bool> one_needed;  ///< for each group: one of it is required wherever the table is read
};

/// Runs a reader on a document and returns its TomlTable::key_uses().
using DocumentReader = std::function<std::vector<KeyUse>(const TomlNodePtr& document)>;

/// The tables that a reader accepts, determined by running it on documents until it uses no new key: first
/// one with every known key, then for each key one with each other form, word and group that the reader
/// accepts there, and one without the key. The readers are the only list of keys; a key that is read only in
/// combination with two unusual, independent values of other keys is not found.
///
/// @param root  path of the outermost table, as "media.NAME"; empty for a whole document
std::vector<TableSchema> explore_keys(const DocumentReader& reader, const std::string& root = "");

}  // namespace scintray::config
