// Mesh files of strangers: what they name beside them, their names, and damage.
#include <sys/stat.h>

#include "mesh/box_files.hpp"
#include "mesh/import_message.hpp"
#include "scintray/core/error.hpp"
#include "scintray/mesh/export/gltf_writer.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/raw_mesh.hpp"
#include "scintray/mesh/weld.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::test;

namespace {

/// A box whose one buffer is in a file, with these members of the glTF file beside.
std::string gltf_with(const std::string& buffer, const std::string& members) {
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":4}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":12,"type":"VEC3"}],
    "bufferViews":[{"buffer":0,"byteLength":144}],
    "buffers":[{"byteLength":144,"uri":")" +
         buffer + "\"}]" + members + "}";
}

/// The corners of the four faces of a tetrahedron.
std::string tetrahedron_bytes() {
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::string bytes;
  for (const auto& face : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    for (const int corner : face) bytes.append(reinterpret_cast<const char*>(corners[corner]), 12);
  return bytes;
}

std::filesystem::path pipe_beside(const std::filesystem::path& file, const std::string& name) {
  const auto pipe = file.parent_path() / name;
  std::filesystem::remove(pipe);
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  return pipe;
}

ImportOptions in_mm() {
  ImportOptions options;
  options.mm_per_unit = 1.0;
  return options;
}

}  // namespace

TEST_CASE("glTF: a picture that is missing, or a pipe, does not matter; a buffer is a file beside it") {
  const auto buffer = mesh_file("tetrahedron.bin", tetrahedron_bytes());
  pipe_beside(buffer, "pipe.png");
  for (const char* picture :
       {"missing.png", "pipe.png", "../../../etc/hostname", "data:image/png;base64,AAAA"}) {
    CAPTURE(picture);
    const std::string pictures = R"(,"images":[{"uri":")" + std::string(picture) +
                                 R"("}],"textures":[{"source":0}],"samplers":[{}],"materials":[{"name":"m",)"
                                 R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    const MeshImport read =
        import_mesh(mesh_file("textured.gltf", gltf_with("tetrahedron.bin", pictures)), 0.0);
    CHECK(read.mesh.triangles.size() == 4);
    CHECK(read.notes.empty());
  }
  pipe_beside(buffer, "pipe.bin");
  std::filesystem::remove(buffer.parent_path() / "link.bin");
  std::filesystem::create_symlink("/etc/hostname", buffer.parent_path() / "link.bin");
  const auto refused = [](const char* name) {
    return message(mesh_file("buffer.gltf", gltf_with(name, "")));
  };
  check_contains(refused("pipe.bin"), {"buffer.gltf", "\"pipe.bin\"", "not a file"});
  check_contains(refused("link.bin"), {"\"link.bin\"", "not in its folder"});
  check_contains(refused("../other.bin"), {"\"../other.bin\"", "not in its folder"});
  check_contains(refused("missing.bin"), {"\"missing.bin\"", "does not exist"});
}

TEST_CASE("OBJ: material libraries are not opened, and materials keep their names") {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  for (const char* library : {"pipe.mtl", "/etc/passwd", "missing.mtl"}) {
    CAPTURE(library);
    const auto path =
        mesh_file("box.obj", "mtllib " + std::string(library) + "\no a\n" + corners +
                                 "usemtl red\nf 1 3 2\nf 1 2 4\nusemtl blue\nf 1 4 3\nf 2 3 4\n");
    pipe_beside(path, "pipe.mtl");
    const MeshImport read = import_mesh(path, 1.0);
    CHECK(read.mesh.groups == std::vector<std::string>{"a:red", "a:blue"});
    CHECK(read.notes.empty());
  }
}

TEST_CASE("Names that are not UTF-8 are taken as Latin-1, and control characters are replaced") {
  CHECK(plain_name("caf\xe9k") == "caf\xc3\xa9k");
  CHECK(plain_name("\xc3\xa9\xe2\x82\xac") == "\xc3\xa9\xe2\x82\xac");
  CHECK(plain_name("a\x1b[31mb\nc\x7f\xc2\x9b") == "a_[31mb_c__");
  CHECK(plain_name("\xff\xc3") == "\xc3\xbf\xc3\x83");
  const auto path =
      mesh_file("latin.obj",
                "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl caf\xe9\x1b[2J\nf 1 3 2\nf 1 2 4\n"
                "f 1 4 3\nf 2 3 4\n");
  const MeshImport read = import_mesh(path, 1.0);
  CHECK(read.mesh.groups == std::vector<std::string>{"a:caf\xc3\xa9_[2J"});
  const auto written = path.parent_path() / "latin.glb";
  write_glb(written, {{"latin", &read.mesh, {}}}, GltfAxes::as_they_are);
  CHECK(import_mesh(written, 0.0).mesh.triangles.size() == 4);
}

TEST_CASE("OFF is read with comments, colours and normals, and what is damaged is refused with its line") {
  const std::string tetrahedron =
      "4 4 6  # counts\n\n0 0 0 1 0 0\n1 0 0 1 0 0\n+0 1 0\n0 0 1\n3 0 2 1 255 0 0\n3 0 1 3\n3 0 3 2\n3 1 2 "
      "3\n";
  for (const char* keyword : {"OFF\n", "OFF ", "# made by hand\nCOFF\n", "NOFF\n", "STCNOFF\r\n"}) {
    CAPTURE(keyword);
    const MeshImport read = import_mesh(mesh_file("t.off", keyword + tetrahedron), 1.0);
    CHECK(read.mesh.triangles.size() == 4);
    CHECK(diagnose(read.mesh).sound());
    CHECK(read.mesh.groups == std::vector<std::string>{"default"});
  }
  const auto refused = [](const std::string& text) { return message(mesh_file("bad.off", text), in_mm()); };
  check_contains(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1\n3 0 1 2\n"), {"bad.off:5", "vertex 3", "three"});
  check_contains(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), {"bad.off:6", "face 1", "not exist"});
  check_contains(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n9 0 1 2\n"), {"bad.off:6", "face 1 of 1"});
  check_contains(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"), {"face 1 of 1", "missing"});
  check_contains(refused("4OFF\n3 1 0\n0 0 0 1\n"), {"keyword OFF", "4OFF"});
  check_contains(refused("OFF BINARY\n3 1 0\n"), "numbers of vertices");
  // The damage that crashed the reader before: a face of several hundred corners in a file of 66 bytes.
  check_contains(refused(" 6 1.3  00 701.0 -1.1  .0OFF\n4 4 6\n0 4 6\n0 0 00\n0 200 757\n0\n000 5\n0 "),
                 {"bad.off:1", "OFF"});
}

TEST_CASE("Vertices that no triangle uses may be anywhere when vertices are welded") {
  TriMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e300, -1e300, 0}, {NAN, 0, INFINITY}};
  mesh.triangles = {{0, 1, 2}};
  CHECK(weld_vertices(mesh, 1e-7) == 2);
  CHECK(mesh.vertices.size() == 3);
}

TEST_CASE("The depth of XML is found in linear time, and comments have none") {
  CHECK(xml_depth("<a><b><c/></b><b/></a>") == 2);
  CHECK(xml_depth("<a><!--<b><c>--><![CDATA[<d><e>]]></a>") == 1);
  // Each of these took minutes when the search for \">\" began anew at every \"<\".
  CHECK(xml_depth("<a><!--" + std::string(4'000'000, '<') + "--></a>") == 1);
  CHECK(xml_depth("<a>" + std::string(4'000'000, '<')) == 1);
  CHECK(xml_depth(std::string(4'000'000, '<') + ">") > kDeepestNesting);
}
