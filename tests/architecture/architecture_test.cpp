#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include "house_rules.hpp"
#include "support/shared.hpp"

using namespace scintray::test;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

/// A small src/ with the layers core, mesh, trace in which everything points down.
fs::path sound_tree(const std::string& name) {
  const fs::path source = scratch_folder(name);
  write(source / "CMakeLists.txt", "set(SCINTRAY_MODULES core mesh\n    trace)\n");
  write(source / "core/CMakeLists.txt", "scintray_module(core SOURCES a.cpp)\n");
  write(source / "core/a.cpp", "#include \"scintray/core/a.hpp\"\n#include <vector>\n");
  write(source / "trace/CMakeLists.txt", "scintray_module(trace SOURCES t.cpp LINK scintray_mesh)  # core\n");
  write(source / "trace/t.cpp", "#include \"scintray/core/a.hpp\"\n#include \"scintray/mesh/m.hpp\"\n");
  return source;
}

void expect_none(const Violations& violations) {
  for (const std::string& violation : violations) FAIL_CHECK(violation);
}

}  // namespace

TEST_CASE("Includes in src point down only") { expect_none(find_upward_includes(source_file("src"))); }

TEST_CASE("CMake links in src point down only") { expect_none(find_upward_links(source_file("src"))); }

TEST_CASE("Every folder of src is one of the layers") {
  expect_none(find_unlisted_modules(source_file("src")));
}

TEST_CASE("geometry, materials and scenes hold data only") {
  for (const char* folder : {"geometry", "materials", "scenes"})
    expect_none(find_code_among_data(source_file(folder)));
}

TEST_CASE("No file names a path of somebody's machine") { expect_none(find_machine_paths(source_file(""))); }

TEST_CASE("The checker passes a sound tree") {
  const fs::path source = sound_tree("architecture_sound");
  CHECK(read_layers(source) == std::vector<std::string>{"core", "mesh", "trace"});
  CHECK(find_upward_includes(source).empty());
  CHECK(find_upward_links(source).empty());
  CHECK(find_unlisted_modules(source).empty());
}

TEST_CASE("The checker finds an include that points up, and says where") {
  const fs::path source = sound_tree("architecture_include");
  write(source / "core/b.hpp", "#pragma once\n  #  include \"scintray/trace/t.hpp\"\n");
  const Violations found = find_upward_includes(source);
  REQUIRE(found.size() == 1);
  CHECK(found[0] == (source / "core/b.hpp").string() +
                        ":2: core uses trace, which stands below it in the list of layers");
}

TEST_CASE("The checker finds includes of unknown modules and includes by another way") {
  const fs::path source = sound_tree("architecture_include_form");
  write(source / "mesh/m.cpp",
        "#include \"../trace/t.hpp\"\n#include \"m.hpp\"\n#include \"scintray/tracer/t.hpp\"\n");
  CHECK(find_upward_includes(source).size() == 3);
}

TEST_CASE("The checker finds a link that points up, under either name of the target") {
  const fs::path source = sound_tree("architecture_link");
  write(source / "core/CMakeLists.txt",
        "scintray_module(core\n  SOURCES a.cpp\n  LINK scintray::mesh scintray_trace)\n");
  CHECK(find_upward_links(source).size() == 2);
}

TEST_CASE("The checker finds a folder that is not one of the layers") {
  const fs::path source = sound_tree("architecture_folder");
  write(source / "extras/e.cpp", "");
  CHECK(find_unlisted_modules(source).size() == 1);
}

TEST_CASE("The checker finds code among data") {
  const fs::path folder = scratch_folder("architecture_data");
  write(folder / "lso.toml", "name = \"LSO\"\n");
  CHECK(find_code_among_data(folder).empty());
  write(folder / "sub/make.py", "print()\n");
  write(folder / "run", "#!/bin/sh\n");
  CHECK(find_code_among_data(folder).size() == 2);
}

TEST_CASE("The checker finds machine paths, and leaves relative paths and addresses alone") {
  const fs::path folder = scratch_folder("architecture_paths");
  const std::string slash = "/";
  write(folder / "fine.md", "see docs/home/index and https://example.org/home/page, ${HOME}" + slash +
                                "work" + slash + "x, a/tmp/b\n");
  CHECK(find_machine_paths(folder).empty());
  write(folder / "bad.md", "in " + slash + "home/someone/x\n\"" + slash + "tmp/y\"\n");
  CHECK(find_machine_paths(folder).size() == 2);
}
