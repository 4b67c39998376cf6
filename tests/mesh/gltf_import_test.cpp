// glTF files.
#include "mesh/box_files.hpp"
#include "scintray/mesh/face_selection.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

namespace {

std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text.push_back(i + k > bytes.size() ? '=' : digits[block >> (18 - 6 * k) & 63U]);
    }
  }
  return text;
}

/// 8 corners as floats, then the sides' triangles as 16-bit indices: 96 + 72 bytes.
std::string gltf_buffer() {
  std::string bytes;
  for (int corner = 0; corner < 8; ++corner) {
    const float xyz[3] = {static_cast<float>(corner & 1), static_cast<float>((corner >> 1 & 1) * 2),
                          static_cast<float>((corner >> 2 & 1) * 3)};
    bytes.append(reinterpret_cast<const char*>(xyz), sizeof xyz);
  }
  for (const auto& quad : kQuads) {
    for (const int k : {0, 1, 2, 0, 2, 3}) {
      bytes.push_back(static_cast<char>(quad[k]));
      bytes.push_back('\0');
    }
  }
  return bytes;
}

/// The box with its last side in the material "polished", the others in "ground".
std::string gltf_text(const std::string& buffer, const std::string& node) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + node + R"(],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0},
                             {"attributes":{"POSITION":0},"indices":2,"material":1}]}],
    "materials":[{"name":"ground"},{"name":"polished"}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,2,3]},
                 {"bufferView":1,"componentType":5123,"count":30,"type":"SCALAR"},
                 {"bufferView":1,"byteOffset":60,"componentType":5123,"count":6,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],
    "buffers":[{"byteLength":168)" +
         buffer + "}]}";
}

std::string embedded() {
  return R"(,"uri":"data:application/octet-stream;base64,)" + base64(gltf_buffer()) + "\"";
}

std::string little_endian(std::uint32_t value) {
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xFFU);
  return bytes;
}

std::string glb(std::string json, const std::string& binary) {
  while (json.size() % 4 != 0) json.push_back(' ');
  return "glTF" + little_endian(2) +
         little_endian(static_cast<std::uint32_t>(28 + json.size() + binary.size())) +
         little_endian(static_cast<std::uint32_t>(json.size())) + "JSON" + json +
         little_endian(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
}

}  // namespace

TEST_CASE("glTF is in metres, moves with its nodes, and its materials are groups") {
  // Turned by 90 degrees about z: (x, y, z) -> (-y, x, z); then scaled before, moved after.
  const std::string node =
      R"({"mesh":0,"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678],"scale":[2,1,1]})";
  const MeshImport read = import_mesh(mesh_file("box.gltf", gltf_text(embedded(), node)), 0.0);
  CHECK(read.unit_from_file == "m");
  CHECK(read.mesh.volume() == doctest::Approx(12e9).epsilon(1e-6));
  CHECK(diagnose(read.mesh).sound());
  const auto bounds = diagnose(read.mesh).bounds;
  CHECK((bounds.min() - Vec3(8000, 0, 0)).norm() < 0.01);
  CHECK((bounds.max() - Vec3(10000, 2000, 3000)).norm() < 0.01);
  CHECK(read.mesh.groups == std::vector<std::string>{"ground", "polished"});
  FaceSelector selector;
  selector.group = "polished";
  const auto mask = select_triangles(read.mesh, selector);
  CHECK(std::count(mask.begin(), mask.end(), 1) == 2);
  for (std::size_t t = 0; t < mask.size(); ++t) {
    if (mask[t]) CHECK(read.mesh.area_vector(t).normalized().z() == doctest::Approx(1.0));
  }
}

TEST_CASE("glTF extras are tags of groups: of node, mesh, material and primitive, the later ones winning") {
  std::string text =
      gltf_text(embedded(), R"({"name":"crystal","mesh":0,"extras":{"finish":"rough","layer":3,)"
                            R"("coated":true,"list":[1],"scale":0.5}})");
  const auto insert = [&text](const std::string& before, const std::string& extras) {
    text.insert(text.find(before) + before.size(), extras);
  };
  insert(R"("name":"polished")", R"(,"extras":{"finish":"smooth","paint":"no"})");
  insert(R"("indices":2,"material":1)", R"(,"extras":{"paint":"white"})");
  const TriMesh mesh = import_mesh(mesh_file("extras.gltf", text), 0.0).mesh;
  CHECK(mesh.groups == std::vector<std::string>{"ground", "polished"});
  CHECK(mesh.tags_of(0) ==
        FaceTags{{"finish", "rough"}, {"layer", "3"}, {"coated", "true"}, {"scale", "0.5"}});
  CHECK(mesh.tags_of(1).at("finish") == "smooth");
  CHECK(mesh.tags_of(1).at("paint") == "white");
  FaceSelector selector;
  selector.tags = {{"layer", "3"}, {"finish", "rough"}};
  const auto mask = select_triangles(mesh, selector);
  CHECK(std::count(mask.begin(), mask.end(), 1) == 10);
  selector.tags["paint"] = "white";
  const auto none = select_triangles(mesh, selector);
  CHECK(std::count(none.begin(), none.end(), 1) == 0);
}

TEST_CASE("A glTF node is a body") {
  const std::string nodes = R"({"name":"a","mesh":0},{"name":"b","mesh":0,"translation":[5,0,0]})";
  std::string text = gltf_text(embedded(), nodes);
  text.replace(text.find("[0]}]"), 3, "[0,1]");
  const std::filesystem::path path = mesh_file("nodes.gltf", text);
  CHECK(import_mesh(path, 0.0).bodies == std::vector<std::string>{"a", "b"});
  ImportOptions options;
  options.body = "b";
  const MeshImport b = import_mesh(path, options);
  check_box(b, 1000.0);
  CHECK(diagnose(b.mesh).bounds.min().x() == doctest::Approx(5000.0));
}

// Fails when the loader comes from libdraco's copy of tinygltf instead of libtinygltf
// (src/mesh/CMakeLists.txt).
TEST_CASE("glTF buffers may lie beside the file") {
  mesh_file("box.bin", gltf_buffer());
  check_box(import_mesh(mesh_file("external.gltf", gltf_text(R"(,"uri":"box.bin")", R"({"mesh":0})")), 1.0),
            1.0);
}

TEST_CASE("glTF buffers may lie in a glb; a given unit replaces the metre") {
  check_box(import_mesh(mesh_file("box.glb", glb(gltf_text("", R"({"mesh":0})"), gltf_buffer())), 1.0), 1.0);
}

TEST_CASE("A mirroring glTF node keeps the box outward") {
  const std::string node = R"({"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  check_box(import_mesh(mesh_file("mirror.gltf", gltf_text(embedded(), node)), 1.0), 1.0);
}
