#pragma once
/// Which keys a reader of TOML knows, what it accepts at each, and beside which others: found by running it.

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
      beside;  ///< keys and values without which it is not read, as `source.type = "photons"`
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

/// The tables that a reader knows, found by giving it documents until it uses no key that it had not used
/// before: first one with every known key, then for each key one with each other form, word and group that
/// the reader accepts there, and one without the key. The readers are the only list of keys; a key that is
/// read only beside two unusual values of others that do not lead to each other is not found.
///
/// @param root  path of the outermost table, as "media.NAME"; empty for a whole document
std::vector<TableSchema> explore_keys(const DocumentReader& reader, const std::string& root = "");

}  // namespace scintray::config
