#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import.hpp"
#include "scintray/mesh/repair.hpp"
#include "support/shared.hpp"

// What is wrong with meshes of public collections, and what repair makes of each.

using namespace scintray;

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
    if (defects->count > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(defects->count) + " " + name;
  return text;
}

std::string steps(const RepairedMesh& repaired) {
  std::string text;
  for (const RepairStep& step : repaired.steps)
    text += (text.empty() ? "" : ", ") + std::to_string(step.where.count) + " " + step.what;
  return text;
}

// Counts of open, flipped and non-manifold edges are those of the collections' own notes; volumes of sound
// meshes are their own, those of mended ones what this repair gave when its result was looked at.
const Expected kMeshes[] = {
@TABLE@
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
    // Nothing is said to be mended that is not, and nothing changes that was sound.
    CHECK(repaired.after.sound() == mesh_problems(repaired.after, "x").empty());
  }
}
