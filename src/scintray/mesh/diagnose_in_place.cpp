#include "scintray/mesh/diagnose_in_place.hpp"

namespace scintray::mesh {

MeshDiagnosis diagnose_in_place(const TriMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const core::Vec3& vertex : mesh.vertices) box.extend(vertex);
  if (box.isEmpty() || !box.center().allFinite()) return diagnose(mesh);
  const core::Vec3 origin = box.center();
  TriMesh moved = mesh;
  for (core::Vec3& vertex : moved.vertices) vertex -= origin;
  MeshDiagnosis diagnosis = diagnose(moved);
  diagnosis.bounds.translate(origin);
  for (Defects* defects : {&diagnosis.open_edges, &diagnosis.nonmanifold_edges, &diagnosis.flipped_edges,
                           &diagnosis.degenerate_triangles, &diagnosis.duplicate_triangles,
                           &diagnosis.self_intersections, &diagnosis.inverted_bodies})
    for (core::Vec3& place : defects->examples) place += origin;
  return diagnosis;
}

}  // namespace scintray::mesh
