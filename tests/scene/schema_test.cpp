/// The keys of a scene as its readers use them (config::explore_keys).

#include "scintray/config/schema.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "scintray/materials/material_forms.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::config;
using namespace scintray::test;

namespace {

/// A reader with keys that depend on a word, on the absence of another key, and on which of a group is given.
std::vector<KeyUse> read_toy(const TomlNodePtr& document) {
  core::Problems ignored;
  const TomlTable root(document, ignored);
  root.record_uses();
  const std::string kind = root.choice("kind", {"plain", "fancy"});
  if (kind == "fancy") {
    const TomlTable fancy = root.table("fancy");
    if (fancy.choice("mode", {"a", "b"}, "a") == "b") fancy.quantity("width", core::Dimension::length);
  }
  if (root.tables("layer").empty()) root.number("single", 2.5);
  if (root.one_of({"near", "far"}, true) == std::optional<std::string>("far"))
    root.table("far").string("name");
  const double share = root.quantity("share", core::Dimension::dimensionless, 0.5);
  root.expect("share", share >= 0.0, "a share cannot be negative");
  return root.key_uses();
}

const KeySchema* find(const std::vector<TableSchema>& tables, const std::string& path,
                      const std::string& key) {
  for (const TableSchema& table : tables)
    for (const KeySchema& one : table.keys)
      if (table.path == path && one.key == key) return &one;
  return nullptr;
}

std::set<std::string> paths(const std::vector<TableSchema>& tables) {
  std::set<std::string> all;
  for (const TableSchema& table : tables)
    for (const KeySchema& key : table.keys)
      all.insert(table.path.empty() ? key.key : table.path + "." + key.key);
  return all;
}

}  // namespace

TEST_CASE(
    "keys beside a word, beside an absent key and of a group are found, with what they are read beside") {
  const std::vector<TableSchema> tables = explore_keys(read_toy);
  const KeySchema* kind = find(tables, "", "kind");
  REQUIRE(kind);
  CHECK(kind->required);
  REQUIRE(kind->forms.size() == 1);
  CHECK(kind->forms[0].words == std::vector<std::string>{"plain", "fancy"});
  const KeySchema* width = find(tables, "fancy", "width");
  REQUIRE(width);
  CHECK(width->beside == std::vector<std::string>{"fancy.mode = \"b\"", "kind = \"fancy\""});
  CHECK(width->forms[0].dimension == core::Dimension::length);
  CHECK_FALSE(find(tables, "fancy", "mode")->required);
  const KeySchema* single = find(tables, "", "single");
  REQUIRE(single);
  CHECK(single->fallback == "2.5");
  CHECK(single->beside == std::vector<std::string>{"without layer"});
  CHECK(find(tables, "far", "name"));
  CHECK(find(tables, "", "share")->fallback == "0.5");
  CHECK(find(tables, "", "share")->rules == std::vector<std::string>{"a share cannot be negative"});
  const auto root =
      std::find_if(tables.begin(), tables.end(), [](const TableSchema& t) { return t.path.empty(); });
  REQUIRE(root->one_of.size() == 1);
  CHECK(root->one_of[0] == std::vector<std::string>{"near", "far"});
  CHECK(root->one_needed[0]);
}

TEST_CASE("exploration finds every key that the shipped scenes make readers look for") {
  const std::set<std::string> found = paths(explore_keys(scene_file::scene_key_uses));
  CHECK(found.size() > 250);
  std::size_t scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_file("scenes"))) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path().string());
    ++scenes;
    for (const std::string& key : scene_file::scene_keys(parse_toml_file(entry.path()))) {
      CAPTURE(key);
      bool known = found.count(key) > 0;
      for (const char* definitions : {"media.", "surfaces.", "sensors.", "reflectors."})
        known = known || key.starts_with(definitions);  // names of their own
      // Curves are one key to the schema: their columns are the same everywhere.
      for (std::size_t dot = key.rfind('.'); !known && dot != std::string::npos; dot = std::string::npos)
        known = found.count(key.substr(0, dot)) > 0 && !key.substr(dot + 1).empty() &&
                (key.ends_with("value") || key.ends_with("_unit") || key.ends_with("_column") ||
                 key.ends_with(".energy") || key.ends_with(".wavelength") || key.ends_with(".file"));
      CHECK(known);
    }
  }
  CHECK(scenes > 10);
}

TEST_CASE("definitions of every kind are explored") {
  const auto keys_of = [](const std::string& kind) {
    return paths(explore_keys(
        [&](const TomlNodePtr& document) { return materials::definition_key_uses(kind, document); },
        kind + ".NAME"));
  };
  CHECK(keys_of("media").count("media.NAME.absorption.length") == 1);
  CHECK(keys_of("media").count("media.NAME.index.sellmeier") == 1);
  CHECK(keys_of("surfaces").count("surfaces.NAME.unified.sigma_alpha") == 1);
  CHECK(keys_of("surfaces").count("surfaces.NAME.base") == 1);
  CHECK(keys_of("sensors").count("sensors.NAME.microcells.pitch") == 1);
  CHECK(keys_of("reflectors").count("reflectors.NAME.direction.specular_share") == 1);
}
