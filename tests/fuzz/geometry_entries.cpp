#include "geometry_entries.hpp"

#include <string>
#include <utility>
#include <vector>

#include "io/gdml_texts.hpp"
#include "require.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scratch_file.hpp"
#include "support/zipped.hpp"
#ifdef SCINTRAY_TESTS_STEP
#include "support/step_shapes.hpp"
#endif

namespace scintray::fuzz {

namespace {

void require_whole(const mesh::TriMesh& mesh) {
  require(!mesh.triangles.empty(), "a mesh without triangles");
  require(mesh.group.size() == mesh.triangles.size(), "triangles without a group");
  for (const std::uint32_t group : mesh.group) require(group < mesh.groups.size(), "a group out of range");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      require(vertex < mesh.vertices.size(), "a vertex out of range");
  for (const core::Vec3& vertex : mesh.vertices) require(vertex.allFinite(), "a vertex that is not finite");
}

bool run_mesh(const std::uint8_t* data, std::size_t size, const char* ending) {
  const ScratchFile file(data, size, ending);
  try {
    mesh::ImportOptions options;
    if (!mesh::states_its_unit(ending)) options.mm_per_unit = 1.0;
    // A coarse one: what a curve is cut in does not depend on the bytes of the file.
    options.tessellation = {1e3, 0.5};
    require_whole(mesh::import_mesh(file.path(), options).mesh);
    return true;
  } catch (const core::InputError& error) {
    require(!error.problems().empty(), "an error without problems");
    for (const core::Problem& problem : error.problems())
      require(problem.where.file == file.path().string() && !problem.what.empty(),
              "an error without place or words");
    return false;
  }
}

bool run_stl(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".stl"); }
bool run_obj(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".obj"); }
bool run_off(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".off"); }
bool run_ply(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".ply"); }
bool run_3mf(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".3mf"); }
bool run_collada(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".dae"); }
bool run_gltf(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".gltf"); }

#ifdef SCINTRAY_TESTS_STEP
bool run_step(const std::uint8_t* data, std::size_t size) { return run_mesh(data, size, ".step"); }

/// The last one begins with a comment as long as the file, whose damage no reader of the solid notices.
std::vector<std::string> step_seeds() {
  const auto path =
      std::filesystem::temp_directory_path() / ("scintray_fuzz_seed_" + std::to_string(getpid()) + ".step");
  std::vector<std::string> seeds;
  for (const test::StepSolid solid : {test::StepSolid::box, test::StepSolid::cylinder}) {
    test::write_step(
        path, {{"crystal", solid, {2.0, 3.0, 4.0}, {0.0, 0.0, 0.0}, {{1, "exit"}}, {{2, "#ff8000"}}, ""}});
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  std::filesystem::remove(path);
  std::string commented = seeds.front();
  commented.insert(commented.find("HEADER;"), "/*" + std::string(commented.size(), ' ') + "*/\n");
  seeds.push_back(std::move(commented));
  return seeds;
}
#endif

bool run_gdml(const std::uint8_t* data, std::size_t size) {
  try {
    exchange::gdml::GdmlImport options;
    options.tessellation = {1e3, 0.5};
    const exchange::SceneDraft scene =
        exchange::gdml::draft_of_gdml({reinterpret_cast<const char*>(data), size}, "fuzz", options);
    for (const auto& [path, mesh] : scene.meshes) require_whole(mesh);
    return true;
  } catch (const core::InputError& error) {
    require_words(error);
    return false;
  }
}

constexpr const char* kCorners[] = {"0 0 0", "1 0 0", "0 2 0", "0 0 3"};
constexpr const char* kFaces[] = {"0 2 1", "0 1 3", "1 2 3", "2 0 3"};

std::string lines(const std::string& before, std::span<const char* const> rows,
                  const std::string& after = "\n") {
  std::string text;
  for (const char* row : rows) text += before + row + after;
  return text;
}

std::vector<std::string> stl_seeds() {
  std::string binary(80, ' ');
  binary += std::string("\x01\0\0\0", 4) + std::string(12, '\0');
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    binary.append(reinterpret_cast<const char*>(&x), 4);
  binary += std::string(2, '\0');
  return {"solid a\nfacet normal 0 0 1\nouter loop\n" + lines("vertex ", std::span(kCorners, 3)) +
              "endloop\nendfacet\nendsolid a\n",
          binary};
}

std::vector<std::string> obj_seeds() {
  return {"o a\n" + lines("v ", kCorners) +
          "usemtl x\nf 1 3 2\nf 1//1 2//1 4//1\nf 2 3 4\no b\nf -2 -4 -1\n"};
}

std::vector<std::string> off_seeds() { return {"OFF\n4 4 6\n" + lines("", kCorners) + lines("3 ", kFaces)}; }

std::vector<std::string> ply_seeds() {
  return {
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
      lines("", kCorners) + lines("3 ", kFaces)};
}

std::vector<std::string> three_mf_model_seeds() {
  return {
      "<model unit=\"inch\"><resources><object id=\"1\" type=\"model\"><mesh><vertices>"
      "<vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/>"
      "</vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources>"
      "<build><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></build></model>"};
}

std::string three_mf(const std::string& model, const std::string& picture = {}) {
  const std::string relationships =
      "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  std::vector<std::pair<std::string, std::string>> parts{{"_rels/.rels", relationships},
                                                         {"3D/3dmodel.model", model}};
  if (!picture.empty()) parts.emplace_back("Metadata/thumbnail.png", picture);
  return test::zipped(parts);
}

/// With a picture as well, whose damage no reader of the mesh notices.
std::vector<std::string> three_mf_seeds() {
  const std::string model = three_mf_model_seeds().front();
  core::Rng rng(20261130, core::StreamKind::other, 0);
  std::string picture(2000, ' ');
  for (char& byte : picture) byte = static_cast<char>(rng.bits() & 0xFF);
  return {three_mf(model), three_mf(model, picture)};
}

/// The bytes are the model, in an archive that is otherwise sound.
bool run_3mf_model(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return false;
  const std::string archive = three_mf({reinterpret_cast<const char*>(data), size});
  return run_3mf(reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size());
}

std::vector<std::string> collada_seeds() {
  return {
      "<COLLADA version=\"1.4.1\"><asset><unit name=\"inch\" meter=\"0.0254\"/></asset><library_geometries>"
      "<geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0"
      "</float_array><technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\">"
      "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
      "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/>"
      "</vertices><triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p>"
      "</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">"
      "<node id=\"n\"><instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
      "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"};
}

std::vector<std::string> gltf_seeds() {
  return {
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[1,2,3],)"
      R"("extras":{"finish":"rough","layer":3}}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":)"
      R"("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"};
}

std::vector<std::string> gdml_seeds() {
  using namespace test;
  GdmlText text;
  text.define =
      "<constant name=\"L\" value=\"2*cm\"/><variable name=\"i\" value=\"0\"/><position name=\"p\" x=\"L\"/>"
      "<matrix name=\"E\" coldim=\"2\" values=\"2.5*eV 1 3*eV 2\"/>";
  text.solids =
      "<tube name=\"t\" rmin=\"1\" rmax=\"5\" z=\"10\" deltaphi=\"twopi\"/><sphere name=\"s\" rmax=\"3\" "
      "deltaphi=\"5\" deltatheta=\"pi\"/><trd name=\"d\" x1=\"1\" x2=\"2\" y1=\"3\" y2=\"4\" z=\"5\"/>"
      "<polycone name=\"c\" deltaphi=\"360\" aunit=\"deg\"><zplane z=\"0\" rmax=\"5\"/><zplane z=\"6\" "
      "rmax=\"3\"/></polycone><opticalsurface name=\"o\" model=\"unified\" finish=\"ground\" "
      "type=\"dielectric_dielectric\" value=\"0.1\"/>";
  text.structure = gdml_volume("a", "t") + gdml_volume("b", "s", "Lead") + gdml_volume("e", "d") +
                   gdml_volume("g", "c") +
                   "<skinsurface name=\"k\" surfaceproperty=\"o\"><volumeref ref=\"a\"/></skinsurface>";
  text.daughters = gdml_placed("x", "a", "<positionref ref=\"p\"/>") + gdml_placed("y", "b") +
                   gdml_placed("z", "e", "<rotation z=\"30\" unit=\"deg\"/>") +
                   "<loop for=\"i\" from=\"0\" to=\"3\" step=\"1\">" +
                   gdml_placed("w[i]", "g", "<position x=\"30*i\"/>") + "</loop>";
  GdmlText boolean = gdml_solid(
      "<box name=\"m\" x=\"2\" y=\"3\" z=\"4\"/><subtraction name=\"it\"><first "
      "ref=\"m\"/><second ref=\"m\"/><position x=\"1\"/></subtraction>");
  std::string entities = boolean.text();
  entities.insert(
      entities.find("<gdml>"),
      "<!DOCTYPE gdml [<!ENTITY one \"1\"><!ENTITY two '&one;+&one;'><!-- - --><!ENTITY far PUBLIC \"p\" "
      "\"far/away.xml\">]>");
  entities.replace(entities.find("x=\"2\""), 5, "x=\"&two;\"");
  return {text.text(), boolean.text(), entities};
}

/// A vertex of six bytes of text becomes three doubles in several copies, and its cell of the welding grid.
constexpr std::size_t kPerMeshByte = 256;
/// A few digits request a wall of up to simple_solids' and solids' own limits, or for kMostPlaced volumes.
constexpr std::size_t kPerGdmlByte = 200'000;

#ifdef SCINTRAY_TESTS_STEP
/// Open CASCADE's tables of entity types and its first blocks of memory.
constexpr std::size_t kOpenCascadesOwn = std::size_t{16} << 20;
#endif
/// assimp reads OBJ through a buffer of 16 MiB.
constexpr std::size_t kAssimpsBuffer = std::size_t{17} << 20;

constexpr Entry kGeometryEntries[] = {
#ifdef SCINTRAY_TESTS_STEP
    {"step", run_step, step_seeds, kPerMeshByte, kOpenCascadesOwn},
#endif
    {"stl", run_stl, stl_seeds, kPerMeshByte},
    {"obj", run_obj, obj_seeds, kPerMeshByte, kAssimpsBuffer},
    {"off", run_off, off_seeds, kPerMeshByte},
    {"ply", run_ply, ply_seeds, kPerMeshByte},
    {"3mf", run_3mf, three_mf_seeds, 1032 * kPerMeshByte},
    {"3mf_model", run_3mf_model, three_mf_model_seeds, kPerMeshByte},
    {"collada", run_collada, collada_seeds, kPerMeshByte},
    {"gltf", run_gltf, gltf_seeds, kPerMeshByte},
    {"gdml", run_gdml, gdml_seeds, kPerGdmlByte}};

}  // namespace

std::span<const Entry> geometry_entries() { return kGeometryEntries; }

}  // namespace scintray::fuzz
