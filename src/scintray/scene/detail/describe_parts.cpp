#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

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
    for (auto& [face, kinds] : kinds_)
      faces_[face].curve =
          std::accumulate(std::next(kinds.begin()), kinds.end(), *kinds.begin(),
                          [](const auto& all, const auto& kind) { return all + ", " + kind; });
    if (!body_.round) return;
    std::vector<SurfaceTriangle> triangles;
    for (std::size_t t = 0; t < geometry_.triangles.size(); ++t)
      triangles.push_back({corners(t), geometry_.support[t]});
    const auto excess = edge_excess(triangles, geometry_.supports);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      FaceInfo& face = faces_[geometry_.face[t]];
      for (const mesh::PatchExcess& more : excess[t]) {
        face.area_mm2 += more.area_mm2;
        info_.volume_mm3 += more.volume_mm3;
        if (triangles[t].support == mesh::kNoSupport)
          face.area_vector_mm2 += more.area_mm2 * doubled_area(triangles[t].corners).normalized();
      }
    }
    info_.bounds = exact_bounds(triangles, geometry_.supports);
  }

 private:
  Corners corners(std::size_t t) const {
    const auto& [a, b, c] = geometry_.triangles[t];
    return {geometry_.vertices[a], geometry_.vertices[b], geometry_.vertices[c]};
  }

  void add_round(std::size_t t) {
    if (geometry_.support[t] == mesh::kNoSupport) return;
    const mesh::SupportSurface& surface = geometry_.supports[geometry_.support[t]];
    FaceInfo& face = faces_[geometry_.face[t]];
    const mesh::FacetDeviation deviation = mesh::facet_deviation(surface, corners(t));
    kinds_[geometry_.face[t]].insert(surface.name());
    face.exact = body_.round;
    face.deviation.distance_mm = std::max(face.deviation.distance_mm, deviation.distance_mm);
    face.deviation.angle_rad = std::max(face.deviation.angle_rad, deviation.angle_rad);
    if (!body_.round) return;
    const mesh::PatchExcess excess = mesh::patch_excess(surface, corners(t));
    face.area_mm2 += excess.area_mm2;
    info_.volume_mm3 += excess.volume_mm3;
  }

  const contact::PlacedPart& geometry_;
  const PartBody& body_;
  PartInfo& info_;
  core::IdVector<core::FaceId, FaceInfo>& faces_;
  std::map<core::FaceId, std::set<std::string>> kinds_;  ///< of the surfaces of each face
};

/// Adds to the areas of interfaces, and of faces in contact, what the exact round faces and their edges add
/// to triangles.
class CurvedInterfaces {
 public:
  CurvedInterfaces(const PartBodies& bodies, const std::vector<contact::InterfaceTriangle>& triangles,
                   const std::vector<core::InterfaceId>& interface_of, Scene& scene)
      : bodies_(bodies), triangles_(triangles), interface_of_(interface_of), scene_(scene) {}

  void add() {
    std::map<core::PartId, std::vector<Side>> sides;  // of exact parts
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const contact::InterfaceTriangle& t = triangles_[i];
      if (t.back_support != mesh::kNoSupport && bodies_[t.back].round)
        add(i, mesh::patch_excess(bodies_[t.back].quadrics[t.back_support], t.vertex).area_mm2);
      const auto add_side = [&](core::PartId part, bool front) {
        const Side side{i, front};
        for (std::size_t k = 0; k < 3; ++k) flat_at_[edge(part, corners(side), k)] = i;
        const bool own_face = (front ? t.front_face : t.back_face).has_value();
        if (own_face && bodies_[part].round) sides[part].push_back(side);
      };
      add_side(t.back, false);
      add_side(t.front, true);
    }
    for (const auto& [part, own] : sides) add_edges(part, own);
    // An edge between two parts is found from both, and beside a third one.
    own_edges_.merge(edges_beside_);
    for (const auto& [edge, area_mm2] : own_edges_) add(edge.first, area_mm2);
  }

 private:
  /// A triangle, seen from the part behind it or from that before it.
  struct Side {
    std::size_t triangle;
    bool front;
  };
  using Point = std::array<double, 3>;
  using Edge = std::tuple<core::PartId, Point, Point>;
  /// A triangle and its side between two points, in either direction.
  using TriangleSide = std::pair<std::size_t, std::pair<Point, Point>>;

  Corners corners(const Side& side) const {
    const Corners& t = triangles_[side.triangle].vertex;
    return side.front ? Corners{t[0], t[2], t[1]} : t;
  }
  std::uint32_t support(const Side& side) const {
    const contact::InterfaceTriangle& t = triangles_[side.triangle];
    return side.front ? t.front_support : t.back_support;
  }
  static Edge edge(core::PartId part, const Corners& t, std::size_t k) {
    return {part, point(t[k]), point(t[(k + 1) % 3])};
  }
  static Point point(const core::Vec3& v) { return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}; }
  static TriangleSide side_of(std::size_t triangle, const Corners& t, std::size_t k) {
    return {triangle, std::minmax({point(t[k]), point(t[(k + 1) % 3])})};
  }

  bool is_on_plane(std::size_t triangle, const Corners& plane) const {
    const contact::InterfaceTriangle& t = triangles_[triangle];
    if (t.back_support != mesh::kNoSupport || t.front_support != mesh::kNoSupport) return false;
    return doubled_area(t.vertex).normalized().cross(doubled_area(plane).normalized()).norm() < 1e-6;
  }

  void add(std::size_t triangle, double area_mm2) {
    const contact::InterfaceTriangle& t = triangles_[triangle];
    scene_.interface_area_mm2[interface_of_[triangle]] += area_mm2;
    if (!t.back_face.has_value() || !t.front_face.has_value()) return;
    scene_.faces[t.back_face].contact_area_mm2 += area_mm2;
    scene_.faces[t.front_face].contact_area_mm2 += area_mm2;
  }

  void add_edges(core::PartId part, const std::vector<Side>& own) {
    std::vector<SurfaceTriangle> boundary;
    for (const Side& side : own) boundary.push_back({corners(side), support(side)});
    const auto excess = edge_excess(boundary, bodies_[part].quadrics);
    for (std::size_t n = 0; n < own.size(); ++n) {
      const contact::InterfaceTriangle& t = triangles_[own[n].triangle];
      for (std::size_t k = 0; k < 3; ++k) {
        if (excess[n][k].area_mm2 == 0.0) continue;
        own_edges_.try_emplace(side_of(own[n].triangle, boundary[n].corners, k), excess[n][k].area_mm2);
        if (boundary[n].support != mesh::kNoSupport) continue;
        // What an end covers of a plane, what is beside the end on this plane does not.
        const auto beside = flat_at_.find(edge(own[n].front ? t.back : t.front, boundary[n].corners, k));
        if (beside != flat_at_.end() && is_on_plane(beside->second, boundary[n].corners))
          edges_beside_.try_emplace(side_of(beside->second, boundary[n].corners, k), -excess[n][k].area_mm2);
      }
    }
  }

  const PartBodies& bodies_;
  const std::vector<contact::InterfaceTriangle>& triangles_;
  const std::vector<core::InterfaceId>& interface_of_;
  Scene& scene_;
  std::map<Edge, std::size_t> flat_at_;                      ///< triangle by region and directed side
  std::map<TriangleSide, double> own_edges_, edges_beside_;  ///< area, mm2
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
  CurvedInterfaces(bodies, triangles, interface_of, scene).add();
}

}  // namespace scintray::scene
