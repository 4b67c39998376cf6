#include "scintray/contact/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scintray/contact/detail/clusters.hpp"
#include "scintray/contact/detail/facing.hpp"

namespace scintray::contact {

namespace {

/// Vertices and triangles of a part whose triangles may not have their faces yet.
Body body_of(const PlacedMesh& part) {
  std::vector<core::FaceId> one_face(part.mesh.triangles.size(), core::FaceId(0));
  return {PlacedPart{part.name, part.mesh.vertices, part.mesh.triangles, std::move(one_face), part.where},
          Eigen::Matrix3d::Identity()};
}

}  // namespace

std::vector<char> touching_triangles(const PlacedMesh& part, const PlacedMesh& other, double tolerance_mm,
                                     double curved_mm) {
  std::vector<char> mask(part.mesh.triangles.size(), 0);
  const double reach = std::max(tolerance_mm, curved_mm);
  if (part.diagnosis.bounds.exteriorDistance(other.diagnosis.bounds) > reach) return mask;
  const std::vector<Body> bodies{body_of(part), body_of(other)};
  for (const BodyPair& pair : near_pairs(bodies, tolerance_mm))
    for (const auto& [t, u] : pair.parallel) {
      if (mask[t] || bodies[0].normal[t].dot(bodies[1].normal[u]) > 0.0) continue;
      // Over the extent of the smaller one, as in the search for contacts.
      const bool own_is_larger = bodies[0].area_vector(t).norm() >= bodies[1].area_vector(u).norm();
      const Plane plane = own_is_larger ? Plane{bodies[0].corner(t, 0), bodies[0].normal[t]}
                                        : Plane{bodies[1].corner(u, 0), bodies[1].normal[u]};
      bool near = true;
      for (int k = 0; k < 3; ++k) {
        const core::Vec3& corner = own_is_larger ? bodies[1].corner(u, k) : bodies[0].corner(t, k);
        near = near && std::abs(plane.height(corner)) <= tolerance_mm;
      }
      mask[t] = near && overlap(bodies[0], t, bodies[1], u, plane).width() > tolerance_mm;
    }
  if (!(curved_mm > tolerance_mm)) return mask;
  const std::vector<Facing> curved = facing(bodies[0], bodies[1], {curved_mm, tolerance_mm});
  for (std::size_t t = 0; t < mask.size(); ++t) mask[t] |= curved[t] != Facing::none;
  return mask;
}

}  // namespace scintray::contact
