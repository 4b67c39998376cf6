#include "scintray/mesh/boolean.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {

namespace {

void expect_sound(const TriMesh& mesh, const std::string& which) {
  const MeshDiagnosis diagnosis = diagnose(mesh);
  if (!diagnosis.sound()) throw core::InputError(mesh_problems(diagnosis, which));
}

}  // namespace

TriMesh combine(const TriMesh& a, const TriMesh& b, BooleanOperation operation) {
  expect_sound(a, "the first body");
  expect_sound(b, "the second body");
  std::optional<BooleanResult> result =
      boolean(a, b, operation, std::max(rounding_length(a), rounding_length(b)));
  if (!result)
    reject_shape(
        "a body of a boolean crosses or touches itself, or the two touch in an edge or a corner only, so "
        "that "
        "their result has no closed surface",
        "let them overlap, or leave a gap between them");
  TriMesh mesh = std::move(result->mesh);
  mesh.groups.clear();
  mesh.group_tags.clear();
  mesh.group.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriMesh& from = result->origin[t].of_second ? b : a;
    const std::uint32_t group = from.group[result->origin[t].triangle];
    mesh.group[t] = mesh.group_index(from.groups[group], from.tags_of(group));
  }
  return mesh;
}

}  // namespace scintray::mesh
