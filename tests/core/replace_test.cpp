// What an output may replace.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <fstream>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/output_file.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

namespace {

const std::map<std::string, std::string> kKinds{{"page", "<!DOCTYPE html>\n<html></html>"},
                                                {"picture", "<?xml version=\"1.0\"?><svg/>"},
                                                {"map", "Gwyddion Simple Field 1.0\nXRes = 3\n"},
                                                {"scene", "# a scene\n\ntitle = \"a = b\"\n[[part]]\n"},
                                                {"definitions", "[surfaces.\"a b\"]\nmodel = \"smooth\"\n"},
                                                {"glb", "glTF\x02"},
                                                {"result", "\x89HDF\r\n\x1a\n and more"},
                                                {"table", "# reweighted\npoint,fraction\n0,0.5\n"},
                                                {"mesh", "ply\nformat ascii 1.0\n"}};

/// Definitions and scenes are one kind; files of no special kind are another.
std::string kind_of(const std::string& name) {
  if (name == "definitions") return "scene";
  return name == "mesh" ? "table" : name;
}

}  // namespace

TEST_CASE("A file replaces its like, an empty file and nothing else") {
  const auto folder = scratch_folder("replace");
  for (const auto& [old_name, old_content] : kKinds)
    for (const auto& [new_name, new_content] : kKinds) {
      const std::string names = old_name + " and " + new_name;
      CAPTURE(names);
      const auto path = folder / "file";
      std::ofstream(path, std::ios::binary) << old_content;
      const std::string refused =
          complaint_of([&, &content = new_content] { write_whole_file(path, content); });
      if (kind_of(old_name) == kind_of(new_name)) {
        CHECK(refused.empty());
        CHECK(read_whole_file(path) == new_content);
      } else {
        check_contains(refused, {"file", "not written over"});
        CHECK(read_whole_file(path) == old_content);
      }
      std::ofstream(path, std::ios::binary | std::ios::trunc).close();
      CHECK_NOTHROW(write_whole_file(path, new_content));
    }
}

TEST_CASE("Pipes, devices and folders are not replaced") {
  const auto folder = scratch_folder("replace_special");
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/null", folder / "device");
  for (const char* name : {"pipe", "device"}) {
    CAPTURE(name);
    check_contains(complaint_of([&] { write_whole_file(folder / name, "text"); }), {name, "device", "pipe"});
    check_contains(complaint_of([&] { h5::File::create(folder / name); }), {name, "not written over"});
    CHECK_FALSE(std::filesystem::is_regular_file(folder / name));
  }
  CHECK_THROWS_AS(write_whole_file(folder, "text"), Error);
}

TEST_CASE("HDF5 does not replace what is not HDF5") {
  const auto path = scratch_folder("replace_h5") / "scene.toml";
  std::ofstream(path) << "title = \"mine\"\n";
  check_contains(complaint_of([&] { h5::File::create(path); }),
                 {"scene.toml", "a TOML file", "not written over"});
  CHECK(read_whole_file(path) == "title = \"mine\"\n");
}
