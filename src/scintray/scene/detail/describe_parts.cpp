#include <algorithm>
#include <map>
#include <set>

#include "scintray/scene/detail/round_parts.hpp"

namespace scintray::scene {

namespace {

/// Sets for every face the vertices of its triangles.
void collect_corners(const contact::PlacedPart& geometry, Scene& scene) {
  std::set<std::pair<core::FaceId, std::uint32_t>> seen;
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t)
    for (const std::uint32_t vertex : geometry.triangles[t])
      if (seen.emplace(geometry.face[t], vertex).second)
        scene.faces[geometry.face[t]].corners.push_back(geometry.vertices[vertex]);
}

/// Adds to areas and volumes what the exact round faces of a part enclose beyond its triangles.
class CurveDescription {
 public:
  CurveDescription(const Assembly& assembly, core::PartId id, const PartBody& body, Scene& scene)
      : geometry_(assembly.parts[id].geometry), body_(body), info_(scene.parts[id]), faces_(scene.faces) {}

  void add() {
    info_.curved = body_.round;
    info_.facets_because = body_.facets_because;
    for (std::size_t t = 0; t < geometry_.triangles.size(); ++t) add_round(t);
    if (!body_.round) return;
    add_ends();
    add_bounds();
  }

 private:
  std::array<core::Vec3, 3> corners(std::size_t t) const {
    const auto& [a, b, c] = geometry_.triangles[t];
    return {geometry_.vertices[a], geometry_.vertices[b], geometry_.vertices[c]};
  }

  void add_round(std::size_t t) {
    if (geometry_.support[t] == mesh::kNoSupport) return;
    const mesh::SupportSurface& surface = geometry_.supports[geometry_.support[t]];
    FaceInfo& face = faces_[geometry_.face[t]];
    const mesh::FacetDeviation deviation = mesh::facet_deviation(surface, corners(t));
    face.curve = surface.name();
    face.exact = body_.round;
    face.deviation.distance_mm = std::max(face.deviation.distance_mm, deviation.distance_mm);
    face.deviation.angle_rad = std::max(face.deviation.angle_rad, deviation.angle_rad);
    if (!body_.round) return;
    const mesh::PatchExcess excess = mesh::patch_excess(surface, corners(t));
    face.area_mm2 += excess.area_mm2;
    info_.volume_mm3 += excess.volume_mm3;
  }

  /// Flat ends reach from the chords of the triangles' outline to the circle; around a hole they end there.
  void add_ends() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> supports;  // of directed sides
    for (std::size_t t = 0; t < geometry_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (geometry_.support[t] != mesh::kNoSupport)
          supports[{geometry_.triangles[t][k], geometry_.triangles[t][(k + 1) % 3]}] = geometry_.support[t];
    for (std::size_t t = 0; t < geometry_.triangles.size(); ++t) {
      if (geometry_.support[t] != mesh::kNoSupport) continue;
      const auto [a, b, c] = corners(t);
      const core::Vec3 normal = (b - a).cross(c - a).normalized();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = geometry_.triangles[t][k], to = geometry_.triangles[t][(k + 1) % 3];
        const auto round = supports.find({to, from});
        if (round == supports.end()) continue;
        const mesh::SupportSurface& surface = geometry_.supports[round->second];
        const core::Vec3 &a_from = geometry_.vertices[from], &a_to = geometry_.vertices[to];
        const double area = mesh::segment_area(surface, normal, a_from, a_to);
        FaceInfo& face = faces_[geometry_.face[t]];
        face.area_mm2 += area;
        face.area_vector_mm2 += area * normal;
      }
    }
  }

  /// The box around the body: by the poles of spheres and the rims of cylinders and cones; where one of these
  /// is cut obliquely, or the body has other faces or is not convex, by the largest deviation of the facets.
  void add_bounds() {
    const auto upright = [&](const mesh::SupportSurface& s) {
      const mesh::SurfaceKind kind = s.kind();
      if (kind != mesh::SurfaceKind::cylinder && kind != mesh::SurfaceKind::cone) return s.is_sphere();
      return std::all_of(body_.planes.begin(), body_.planes.end(),
                         [&](const WorldPlane& plane) { return s.axis.cross(plane.normal).norm() < 1e-9; });
    };
    if (!body_.convex || !std::all_of(body_.quadrics.begin(), body_.quadrics.end(), upright)) {
      const core::Vec3 bulge = core::Vec3::Constant(2.0 * body_.deviation_mm);
      info_.bounds = Eigen::AlignedBox3d(info_.bounds.min() - bulge, info_.bounds.max() + bulge);
      return;
    }
    for (std::size_t t = 0; t < geometry_.triangles.size(); ++t) {
      if (geometry_.support[t] == mesh::kNoSupport) continue;
      const mesh::SupportSurface& surface = geometry_.supports[geometry_.support[t]];
      for (const core::Vec3& corner : corners(t)) {
        const core::Vec3 middle = surface.middle(corner);
        const double radius = (corner - middle).norm();
        for (int axis = 0; axis < 3; ++axis) {
          core::Vec3 side = core::Vec3::Unit(axis);
          if (!surface.is_sphere()) side -= surface.axis[axis] * surface.axis.vec();
          if (!(side.norm() > 1e-9)) continue;
          side *= radius / side.norm();
          for (const core::Vec3& point : {core::Vec3(middle + side), core::Vec3(middle - side)})
            if (on_body(point)) info_.bounds.extend(point);
        }
      }
    }
  }

  /// Whether a point of a round face is one of the body, too.
  bool on_body(const core::Vec3& point) const {
    const double rounding = 1e-9 * info_.bounds.diagonal().norm();
    return std::all_of(
               body_.planes.begin(), body_.planes.end(),
               [&](const WorldPlane& plane) { return plane.normal.dot(point) <= plane.offset + rounding; }) &&
           std::all_of(body_.quadrics.begin(), body_.quadrics.end(),
                       [&](const mesh::SupportSurface& s) { return s.distance(point) <= rounding; });
  }

  const contact::PlacedPart& geometry_;
  const PartBody& body_;
  PartInfo& info_;
  core::IdVector<core::FaceId, FaceInfo>& faces_;
};

}  // namespace

void describe_parts(const Assembly& assembly, Scene& scene) {
  for (const AssemblyFace& face : assembly.faces) {
    FaceInfo info;
    info.name = face.name;
    info.part = face.part;
    info.surface = name_or_smooth(face.surface);
    scene.faces.push_back(std::move(info));
  }
  for (const core::PartId id : assembly.parts.ids()) {
    const contact::PlacedPart& geometry = assembly.parts[id].geometry;
    PartInfo info;
    info.name = geometry.name;
    info.region = region_of(id);
    info.sensor = assembly.parts[id].sensor;
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
      const auto& [a, b, c] = geometry.triangles[t];
      const core::Vec3 &va = geometry.vertices[a], &vb = geometry.vertices[b], &vc = geometry.vertices[c];
      const core::Vec3& origin = geometry.vertices.front();  // for precision far from the origin
      info.volume_mm3 += (va - origin).dot((vb - origin).cross(vc - origin)) / 6.0;
      for (const core::Vec3& v : {va, vb, vc}) info.bounds.extend(v);
      FaceInfo& face = scene.faces[geometry.face[t]];
      const core::Vec3 area = 0.5 * (vb - va).cross(vc - va);
      face.area_mm2 += area.norm();
      face.area_vector_mm2 += area;
      ++face.triangles;
    }
    scene.parts.push_back(info);
    collect_corners(geometry, scene);
  }
}

void describe_curves(const Assembly& assembly, const PartBodies& bodies,
                     const std::vector<contact::InterfaceTriangle>& triangles,
                     const std::vector<core::InterfaceId>& interface_of, Scene& scene) {
  for (const core::PartId part : assembly.parts.ids())
    if (!assembly.parts[part].geometry.supports.empty())
      CurveDescription(assembly, part, bodies[part], scene).add();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const contact::InterfaceTriangle& t = triangles[i];
    if (t.back_support == mesh::kNoSupport || !bodies[t.back].round) continue;
    const double more = mesh::patch_excess(bodies[t.back].quadrics[t.back_support], t.vertex).area_mm2;
    scene.interface_area_mm2[interface_of[i]] += more;
    if (!t.front_face.has_value()) continue;
    scene.faces[t.back_face].contact_area_mm2 += more;
    scene.faces[t.front_face].contact_area_mm2 += more;
  }
}

}  // namespace scintray::scene
