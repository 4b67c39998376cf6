#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/repair/repair.hpp"
#include "support/shared.hpp"

// What is wrong with meshes of public collections, and what repair makes of each.

using namespace scintray;
using namespace scintray::mesh;

namespace {

struct Expected {
  const char* file;
  const char* found;  ///< diagnosis as kinds with counts, in the order of summary(); "" for sound
  const char* done;   ///< the steps of the repair, with counts
  bool mended;
  std::size_t bodies;  ///< in the end
  double volume_mm3;   ///< in the end; of meshes that stay open it means nothing and is not compared
};

std::string summary(const MeshDiagnosis& d) {
  std::string text;
  const std::pair<const char*, const Defects*> kinds[] = {{"open", &d.open_edges},
                                                          {"non-manifold", &d.nonmanifold_edges},
                                                          {"flipped", &d.flipped_edges},
                                                          {"flat", &d.degenerate_triangles},
                                                          {"duplicate", &d.duplicate_triangles},
                                                          {"crossing", &d.self_intersections},
                                                          {"inverted", &d.inverted_bodies}};
  for (const auto& [name, defects] : kinds)
    if (defects->count > 0) text += (text.empty() ? "" : ", ") + std::to_string(defects->count) + " " + name;
  return text;
}

std::string steps(const RepairedMesh& repaired) {
  std::string text;
  for (const RepairStep& step : repaired.steps)
    text += (text.empty() ? "" : ", ") + std::to_string(step.where.count) + " " + step.what;
  return text;
}

// Counts of open, flipped and non-manifold edges are those of the collections' own notes; volumes of sound
// meshes are their own, those of repaired ones are results of this repair that were inspected.
const Expected kMeshes[] = {
    {"assimp/BoxBadNormals.glb", "", "", true, 1, 1},
    {"assimp/Spider_ascii.stl", "72 open, 10 flipped, 317 crossing",
     "10 edges whose triangles disagreed, mended by turning triangles round, 6 holes filled, 4 duplicate "
     "triangles removed, 17 pairs of bodies that cross or touch united",
     true, 1, 9.68762},
    {"assimp/box.3mf", "", "", true, 1, 6000},
    {"assimp/box_mat_with_spaces.obj", "", "", true, 1, 1},
    {"assimp/box_without_lineending.obj", "", "", true, 1, 1},
    {"assimp/cube_binary_starts_with_nl.ply", "", "", true, 1, 1},
    {"assimp/sphereWithHole.stl", "9 open", "3 holes filled", true, 1, 13.5816},
    {"assimp/triangle_with_two_solids.stl", "6 open", "", false, 2, 0},
    {"assimp/triangle_with_empty_solid.stl", "3 open", "", false, 1, 0},
    {"cadmesh/box_solidworks.ply", "", "", true, 1, 16296.3},
    {"cadmesh/box_solidworks.stl", "", "", true, 1, 16296.3},
    {"cadmesh/shapes.obj", "", "", true, 4, 10.4487},
    {"cadmesh/sphere.ply", "", "", true, 1, 4.15274},
    {"trimesh/20mm-xyz-cube.stl", "", "", true, 1, 7938.68},
    {"trimesh/busted.STL", "", "", true, 1, 526.449},
    {"trimesh/counterX.3MF", "", "", true, 1, 885303},
    {"trimesh/cylinder.stl", "", "", true, 1, 25.0924},
    {"trimesh/multibody.stl", "12 flipped",
     "12 edges whose triangles disagreed, mended by turning triangles round", true, 2, 0.00742322},
    {"trimesh/nancolor.obj", "", "", true, 1, 1},
    {"trimesh/negative_indices.obj", "", "", true, 1, 8},
    {"trimesh/not_convex.obj", "12 non-manifold, 156 crossing",
     "12 edges of several bodies parted, 7 pairs of bodies that cross or touch united", true, 1, 0.0308148},
    {"trimesh/notenoughindices.obj", "3 open", "", false, 1, 0},
    {"trimesh/origin_inside.STL", "", "", true, 1, 0.96875},
    {"trimesh/plate_holes.STL", "", "", true, 1, 767362},
    {"trimesh/round.stl", "", "", true, 1, 277.915},
    {"trimesh/two_objects_mixed_case_names.stl", "", "", true, 2, 2},
    {"trimesh/unit_cube.STL", "", "", true, 1, 1},
    {"trimesh/wallhole.obj", "", "", true, 1, 1066.67},
    {"trimesh/whitespace.off", "", "", true, 1, 12.3168},
};

}  // namespace

TEST_CASE("Meshes of public collections: what each is diagnosed as, and what repair makes of it") {
  for (const Expected& expected : kMeshes) {
    CAPTURE(expected.file);
    const auto path = test::shared_file(std::string("data/meshes/") + expected.file);
    if (!path) return;
    const RepairedMesh repaired = repair_mesh(import_mesh(*path, 1.0).mesh);
    CHECK(summary(repaired.before) == expected.found);
    CHECK(steps(repaired) == expected.done);
    CHECK(repaired.after.sound() == expected.mended);
    CHECK(repaired.after.bodies == expected.bodies);
    if (expected.mended)
      CHECK(repaired.after.volume_mm3 == doctest::Approx(expected.volume_mm3).epsilon(1e-4));
    // Nothing is reported as repaired that is not, and sound meshes do not change.
    CHECK(repaired.after.sound() == mesh_problems(repaired.after, "x").empty());
  }
}
