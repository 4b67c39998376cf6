#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/import/import.hpp"
#include "support/shared.hpp"

// Meshes of public collections and the defects that their own projects state.

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

struct Read {
  MeshImport import;
  MeshDiagnosis diagnosis;
};

std::optional<Read> read(const std::string& name) {
  const auto path = test::shared_file("data/meshes/" + name);
  if (!path) return std::nullopt;
  Read result{import_mesh(*path, 1.0), {}};
  result.diagnosis = diagnose(result.import.mesh);
  return result;
}

}  // namespace

TEST_CASE("assimp's Spider_ascii.stl has 56 triangles without area, 72 open and 10 flipped edges") {
  const auto spider = read("assimp/Spider_ascii.stl");
  if (!spider) return;
  CHECK(spider->import.degenerate_triangles == 56);
  CHECK(spider->diagnosis.open_edges.count == 72);
  CHECK(spider->diagnosis.flipped_edges.count == 10);
  CHECK_FALSE(spider->diagnosis.closed());
}

TEST_CASE("assimp's sphereWithHole.stl has 9 open edges") {
  const auto hole = read("assimp/sphereWithHole.stl");
  if (!hole) return;
  CHECK(hole->diagnosis.open_edges.count == 9);
}

TEST_CASE("A PLY whose header announces one face more than follows is refused, not filled up") {
  const auto path = test::shared_file("data/meshes/cadmesh/sphereWithMissingFace.ply");
  if (!path) return;
  CHECK_THROWS_WITH_AS(import_mesh(*path, 1.0), doctest::Contains("number 1280 of 1280 is missing"),
                       InputError);
}

TEST_CASE("trimesh's multibody.stl has 12 flipped edges, which orientation mends") {
  auto multibody = read("trimesh/multibody.stl");
  if (!multibody) return;
  CHECK(multibody->diagnosis.flipped_edges.count == 12);
  CHECK(multibody->diagnosis.bodies == 2);
  CHECK(orient_outwards(multibody->import.mesh));
  CHECK(diagnose(multibody->import.mesh).sound());
}

TEST_CASE("trimesh's not_convex.obj has 12 non-manifold edges") {
  const auto mesh = read("trimesh/not_convex.obj");
  if (!mesh) return;
  CHECK(mesh->diagnosis.nonmanifold_edges.count == 12);
  CHECK(mesh->diagnosis.self_intersections.count > 0);
}

TEST_CASE("Sound meshes of the collections are found sound, with their volumes") {
  const std::pair<const char*, double> cases[] = {{"assimp/BoxBadNormals.glb", 1.0},
                                                  {"assimp/box.3mf", 6000.0},
                                                  {"assimp/cube_binary_starts_with_nl.ply", 1.0},
                                                  {"trimesh/unit_cube.STL", 1.0},
                                                  {"trimesh/negative_indices.obj", 8.0},
                                                  {"trimesh/nancolor.obj", 1.0},
                                                  {"trimesh/two_objects_mixed_case_names.stl", 2.0},
                                                  {"assimp/box_mat_with_spaces.obj", 1.0}};
  for (const auto& row : cases) {
    const auto& name = row.first;
    const auto& volume = row.second;
    CAPTURE(name);
    const auto mesh = read(name);
    if (!mesh) return;
    CHECK(mesh->diagnosis.sound());
    CHECK(mesh->diagnosis.volume_mm3 == doctest::Approx(volume).epsilon(1e-5));
  }
}
