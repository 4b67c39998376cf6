// docs/gamma_sources.md and the reader of [source] agree.
#include <set>
#include <sstream>

#include "event_scene.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

std::string documentation() { return read_text_file(source_file("docs/gamma_sources.md")); }

/// First words in backticks of the rows of tables under headings that name a type.
std::set<std::string> documented_keys() {
  std::set<std::string> keys;
  bool in_types = false;
  std::istringstream lines(documentation());
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("## ", 0) == 0) in_types = line.find("`type = ") != std::string::npos;
    if (!in_types || line.rfind("| `", 0) != 0) continue;
    const std::string cell = line.substr(0, line.find('|', 1));
    for (auto open = cell.find('`'); open != std::string::npos;) {
      const auto close = cell.find('`', open + 1);
      keys.insert(cell.substr(open + 1, close - open - 1));
      open = cell.find('`', close + 1);
    }
  }
  return keys;
}

/// Keys that the reader requests, whatever is in the file.
std::set<std::string> read_keys() {
  std::set<std::string> keys;
  for (const std::string text :
       {"type = \"gamma_events\"\nspectrum = 1\nregion = { part = \"crystal\", box = { } }",
        "type = \"gammas\"\nemission = \"gamma\"\nplane = { }\ndirection = { cone = [0, 0, 1] "
        "}\n[[matter]]\npart = "
        "\"crystal\"\nmass_fractions = { H = 1 }",
        "type = \"gammas\"\nemission = \"pair\"\nposition = [1, 2, 3]",
        "type = \"hits\"\nfile = \"README.md\"\ncolumns = { }\ngroup = \"x\"\ntime_unit = \"ns\"",
        "type = \"photon_list\"\nfile = \"README.md\"\ncolumns = { }\ngroup = \"x\"\ntime_unit = \"ns\""}) {
    Problems ignored;
    const TomlTable table(parse_toml(text, scene_path()), ignored);
    read_gamma_source(table, {"crystal"});
    for (const std::string& key : table.known_keys()) keys.insert(key);
  }
  keys.erase("matter.mass_fractions.H");
  return keys;
}

}  // namespace

TEST_CASE("the documentation has the keys that are read, and no others") {
  const std::set<std::string> documented = documented_keys(), read = read_keys();
  for (const std::string& key : read) {
    CAPTURE(key);
    CHECK(documented.count(key) == 1);
  }
  for (const std::string& key : documented) {
    CAPTURE(key);
    CHECK(read.count(key) == 1);
  }
}

TEST_CASE("the documented examples are read") {
  const std::string text = documentation();
  int examples = 0;
  for (auto begin = text.find("```toml\n[source]\n"); begin != std::string::npos;
       begin = text.find("```toml\n[source]\n", begin + 1)) {
    const auto first = begin + std::string("```toml\n[source]\n").size();
    const std::string body = text.substr(first, text.find("```", first) - first);
    Problems problems;
    const std::string whole = "[source]\n" + body;
    const TomlTable root(parse_toml(whole, scene_path()), problems);
    read_gamma_source(root.table("source"), {"crystal", "shield", "pmt"});
    root.finish();
    for (const Problem& problem : problems.list()) {
      CAPTURE(problem.text());
      CHECK(problem.what.find("does not exist") != std::string::npos);  // files of the examples
    }
    ++examples;
  }
  CHECK(examples >= 3);
}
