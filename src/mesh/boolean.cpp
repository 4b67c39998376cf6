#include "scintray/mesh/boolean.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Surface_mesh.h>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shape_error.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = SurfaceMesh::Face_index;

using GroupOfFace = SurfaceMesh::Property_map<Face, std::uint32_t>;

GroupOfFace groups_of(SurfaceMesh& mesh) {
  return mesh.add_property_map<Face, std::uint32_t>("f:group", 0).first;
}

/// Faces that are cut, or copied into another mesh, hand their group on.
struct GroupKeeper : public pmp::Corefinement::Default_visitor<SurfaceMesh> {
  std::uint32_t group = 0;
  void before_subface_creations(Face split, SurfaceMesh& mesh) { group = groups_of(mesh)[split]; }
  void after_subface_created(Face made, SurfaceMesh& mesh) { groups_of(mesh)[made] = group; }
  void after_face_copy(Face source, const SurfaceMesh& from, Face target, SurfaceMesh& to) {
    groups_of(to)[target] = groups_of(const_cast<SurfaceMesh&>(from))[source];
  }
};

/// Groups are numbers of `names`.
SurfaceMesh to_cgal(const TriMesh& mesh, TriMesh& names, const std::string& which) {
  const MeshDiagnosis diagnosis = diagnose(mesh);
  if (!diagnosis.sound()) throw InputError(mesh_problems(diagnosis, which));
  SurfaceMesh result;
  const GroupOfFace group = groups_of(result);
  for (const Vec3& v : mesh.vertices) result.add_vertex({v.x(), v.y(), v.z()});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Face face = result.add_face(SurfaceMesh::Vertex_index(a), SurfaceMesh::Vertex_index(b),
                                      SurfaceMesh::Vertex_index(c));
    if (face == SurfaceMesh::null_face())
      reject_shape(which + " touches itself in an edge or a corner", "separate its parts a little");
    group[face] = names.group_index(mesh.groups[mesh.group[t]], mesh.tags_of(mesh.group[t]));
  }
  return result;
}

TriMesh from_cgal(SurfaceMesh& mesh, TriMesh names) {
  mesh.collect_garbage();
  const GroupOfFace group = groups_of(mesh);
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    names.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const Face face : mesh.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t corner = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(face))) corners[corner++] = v;
    names.triangles.push_back(corners);
    names.group.push_back(group[face]);
  }
  return names;
}

}  // namespace

TriMesh boolean(const TriMesh& a, const TriMesh& b, BooleanOperation operation) {
  TriMesh names;
  SurfaceMesh first = to_cgal(a, names, "the first body"), second = to_cgal(b, names, "the second body");
  SurfaceMesh result;
  groups_of(result);
  const auto parameters = CGAL::parameters::visitor(GroupKeeper()).throw_on_self_intersection(true);
  bool closed = false;
  try {
    switch (operation) {
      case BooleanOperation::join:
        closed = pmp::corefine_and_compute_union(first, second, result, parameters);
        break;
      case BooleanOperation::subtract:
        closed = pmp::corefine_and_compute_difference(first, second, result, parameters);
        break;
      case BooleanOperation::intersect:
        closed = pmp::corefine_and_compute_intersection(first, second, result, parameters);
        break;
    }
  } catch (const pmp::Corefinement::Self_intersection_exception&) {
    reject_shape("a body of a boolean crosses itself", "repair it before");
  }
  if (!closed)
    reject_shape(
        "the two bodies of a boolean touch in an edge or a corner only, so that their result has no closed "
        "surface",
        "let them overlap, or leave a gap between them");
  TriMesh mesh = from_cgal(result, std::move(names));
  // Where faces lie on each other, or an edge meets a face at its border, slivers are left.
  const double length_mm = rounding_length(mesh);
  weld_vertices(mesh, length_mm);
  remove_degenerate(mesh, length_mm);
  return mesh;
}

}  // namespace scintray
