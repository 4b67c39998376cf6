#include "scintray/scene/contact_overlap.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

namespace scintray::contact {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

std::optional<Mesh> to_mesh(const PlacedPart& part) {
  const Body body(part, Eigen::Matrix3d::Identity());  // makes equal positions one vertex
  std::vector<Kernel::Point_3> points;
  for (const Vec3& v : body.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::vector<std::size_t>> triangles;
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t)
    if (!body.normal[t].isZero()) triangles.emplace_back(body.triangles[t].begin(), body.triangles[t].end());
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) return std::nullopt;
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  if (!CGAL::is_closed(mesh) || !pmp::does_bound_a_volume(mesh)) return std::nullopt;
  return mesh;
}

PlacedPart from_mesh(const Mesh& mesh) {
  PlacedPart part;
  std::vector<std::uint32_t> index(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  for (const auto v : mesh.vertices()) {
    index[v.idx()] = static_cast<std::uint32_t>(part.vertices.size());
    // exact(): a lazy number's own conversion is only good to five digits.
    const auto& p = CGAL::exact(mesh.point(v));
    part.vertices.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
  }
  for (const auto f : mesh.faces()) {
    std::array<std::uint32_t, 3> corners{};
    int k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) corners[k++] = index[v.idx()];
    part.triangles.push_back(corners);
  }
  part.face.assign(part.triangles.size(), 0);
  return part;
}

std::optional<OverlapVolume> boolean_overlap(const PlacedPart& a, const PlacedPart& b) {
  auto mesh_a = to_mesh(a), mesh_b = to_mesh(b);
  if (!mesh_a || !mesh_b) return std::nullopt;
  Mesh common;
  try {
    if (!pmp::corefine_and_compute_intersection(*mesh_a, *mesh_b, common,
                                                CGAL::parameters::throw_on_self_intersection(true)))
      return std::nullopt;
  } catch (const pmp::Corefinement::Self_intersection_exception&) {
    return std::nullopt;
  }
  if (common.is_empty()) return std::nullopt;
  pmp::triangulate_faces(common);
  const Body body(from_mesh(common), Eigen::Matrix3d::Identity());
  return OverlapVolume{body.volume, body.interior_point(), true};
}

OverlapVolume grid_overlap(const PlacedPart& a, const PlacedPart& b) {
  constexpr int kPerSide = 32;
  const Body body_a(a, Eigen::Matrix3d::Identity()), body_b(b, Eigen::Matrix3d::Identity());
  const Vec3 low = body_a.box.low.cwiseMax(body_b.box.low);
  const Vec3 size = body_a.box.high.cwiseMin(body_b.box.high) - low;
  OverlapVolume result{0.0, low + 0.5 * size, false};
  int count = 0;
  for (int i = 0; i < kPerSide; ++i)
    for (int j = 0; j < kPerSide; ++j)
      for (int k = 0; k < kPerSide; ++k) {
        const Vec3 p = low + Vec3((i + 0.5) * size.x(), (j + 0.5) * size.y(), (k + 0.5) * size.z()) / kPerSide;
        if (body_a.side_of(p, 0.0) != Side::inside || body_b.side_of(p, 0.0) != Side::inside) continue;
        if (count++ == 0) result.inside = p;
      }
  result.volume_mm3 = size.prod() * count / (kPerSide * kPerSide * kPerSide);
  return result;
}

}  // namespace

OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b) {
  if (const auto exact = boolean_overlap(a, b)) return *exact;
  return grid_overlap(a, b);
}

}  // namespace scintray::contact
