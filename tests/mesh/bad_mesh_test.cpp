#include <doctest/doctest.h>

#include <fstream>
#include <iostream>

#include "import_message.hpp"
#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/import/import.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

namespace {

std::filesystem::path write(const std::string& name, const std::string& text) {
  static const auto folder = test::scratch_folder("mesh_bad");
  const auto path = folder / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// The complaint about a file whose lengths are in this many mm.
std::string in_mm(const std::filesystem::path& path, double mm_per_unit = 1.0) {
  ImportOptions options;
  options.mm_per_unit = mm_per_unit;
  return message(path, options);
}

}  // namespace

TEST_CASE("Messages about mesh files name the file, the fault and the remedy") {
  check_contains(in_mm("/nowhere/crystal.stl"), "there is no such file");
  check_contains(in_mm("/nowhere/crystal.stl"), "/nowhere/crystal.stl");
  check_contains(in_mm("crystal.iges"), ".stl, .obj, .ply, .off, .3mf, .dae, .gltf, .glb, .step, .stp");
  check_contains(in_mm(write("empty.obj", "")), {"mesh file", "empty"});
  check_contains(in_mm(write("none.stl", "solid a\nendsolid a\n")), "no triangles");
  check_contains(in_mm(write("unit.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), 0.0), "unit = \"mm\"");
  check_contains(in_mm(write("unit.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), -1.0),
                 "not a positive length");
  check_contains(in_mm(write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nv 1 1 1\nf 1 3 4\nf 1 2 3\n")),
                 {"vertex 2 of triangle 2", "(nan, 0, 0)"});
  check_contains(in_mm(write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), {"no triangle", "area"});
  check_contains(in_mm(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), "cannot read the mesh");
}

TEST_CASE("Counts that cannot be true are refused before anything is allocated") {
  std::string stl(84, '\0');
  stl[80] = stl[81] = stl[82] = stl[83] = '\xff';
  check_contains(in_mm(write("count.stl", stl)), "announces 4294967295 triangles");
  check_contains(in_mm(write("short.stl", std::string(40, '\x01'))), "header of 84 bytes");
  check_contains(in_mm(write("count.off", "OFF\n4000000000 1 0\n0 0 0\n")), "announces 4000000000 vertices");
  check_contains(in_mm(write("count.ply",
                             "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                             "end_header\n")),
                 "announces 4000000000 elements \"vertex\"");
  const std::string list_header =
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uint int vertex_indices\nend_header\n";
  check_contains(in_mm(write("list.ply", list_header + "4000000000 0 0 0\n")),
                 {"element \"face\" number 1 of 1", "missing", "not a number"});
  check_contains(in_mm(write("corner.ply", list_header + "3 0 1 2\n")), {"vertex", "not exist"});
  check_contains(in_mm(write("order.ply", "ply\nproperty float x\nend_header\n")),
                 "order.ply:2: error: a property");
  check_contains(in_mm(write("count.dae", "<COLLADA><float_array count=\"4000000000\"/></COLLADA>")),
                 "no visual scene");
  check_contains(in_mm(write("junk.3mf", "PK but not a zip")), "damaged zip archive");
}

TEST_CASE("Malformed glTF is refused with messages") {
  const std::string asset = R"({"asset":{"version":"2.0"})";
  check_contains(in_mm(write("not.gltf", "not json")), {"cannot read", "glTF"});
  check_contains(in_mm(write("deep.gltf", std::string(100000, '['))), {"nested", "500 deep"});
  check_contains(in_mm(write("cut.glb", "glTF")), {"cannot read", "glTF"});
  check_contains(in_mm(write("none.gltf", asset + "}")), "no triangles");
  check_contains(
      in_mm(write("loop.gltf", asset + R"(,"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}]})")),
      "inside itself");
  check_contains(
      in_mm(write("draco.gltf", asset + R"(,"extensionsRequired":["KHR_draco_mesh_compression"]})")),
      "KHR_draco_mesh_compression");
  const std::string head =
      asset + R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":)";
  check_contains(in_mm(write("accessor.gltf", head + R"([{"attributes":{"POSITION":7}}]}]})")),
                 {"accessor 7", "not exist"});
  const std::string buffer = R"("bufferViews":[{"buffer":0,"byteLength":3}],"buffers":[{"byteLength":3,)"
                             R"("uri":"data:application/octet-stream;base64,AAAA"}]})";
  check_contains(
      in_mm(write("beyond.gltf", head +
                                     R"([{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
                                     R"("componentType":5126,"count":1000000000,"type":"VEC3"}],)" +
                                     buffer)),
      "reaches beyond its buffer");
}

TEST_CASE("Every odd file of the reference collections is read or refused, never more") {
  const auto folder = test::shared_file("data/meshes");
  if (!folder) return;
  std::size_t read = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    if (!entry.is_regular_file()) continue;
    INFO(entry.path().string());
    try {
      const MeshImport mesh = import_mesh(entry.path(), 1.0);
      CHECK(diagnose(mesh.mesh).triangles > 0);
      ++read;
    } catch (const InputError& error) {
      CHECK(error.problems().front().where.file == entry.path().string());
      ++refused;
    }
  }
  std::cout << read << " reference meshes read, " << refused << " refused\n";
  CHECK(read >= 20);
  CHECK(refused >= 4);
}

TEST_CASE("A file cut anywhere, or with a byte changed, is read or refused") {
  const auto source = test::source_file("geometry/crystal_2x2x20.stl");
  std::ifstream file(source, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/2 4/4\nf 2//2 3//3 4//4\nf 3 1 -1\n";
  const std::string off = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3\n";
  std::size_t tried = 0;
  for (const auto& sound :
       {std::pair{"cut.stl", whole}, {"cut.ply", ply}, {"cut.obj", obj}, {"cut.off", off}}) {
    const auto& name = sound.first;
    const auto& text = sound.second;
    for (std::size_t at = 0; at < text.size(); at += text.size() / 60 + 1) {
      std::string changed = text;
      changed[at] = static_cast<char>(changed[at] ^ 0x15);
      for (const std::string& variant : {text.substr(0, at), changed}) {
        const auto path = write(name, variant);
        INFO(name << " at byte " << at);
        CHECK_NOTHROW(in_mm(path));
        ++tried;
      }
    }
  }
  CHECK(tried > 300);
}
