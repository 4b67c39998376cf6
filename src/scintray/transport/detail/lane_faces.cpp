#include "scintray/transport/detail/lane_scene.hpp"

#include <cstddef>

#include "scintray/transport/detail/photon_numbers.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

LaneBody::Face numbers_of(const scene::BodyPlane& plane) {
  LaneBody::Face face{};
  copy(plane.normal, face.axis);
  face.outwards = 1.0;
  face.offset = plane.offset;
  return face;
}

LaneBody::Face numbers_of(const scene::BodyQuadric& quadric) {
  LaneBody::Face face{};
  copy(quadric.surface.origin, face.origin);
  copy(quadric.surface.axis, face.axis);
  face.axial = quadric.surface.axial;
  face.slope = quadric.surface.slope;
  face.radius2 = quadric.surface.radius2;
  if (quadric.surface.is_cylinder())
    face.inverse_radius = scene::Accelerator::inverse_radius(quadric.surface);
  face.outwards = quadric.around_region ? 1.0 : -1.0;
  return face;
}

}  // namespace

LaneFaces::LaneFaces(const scene::Scene& scene, const scene::Region& region)
    : boundary_(&scene.accelerator(region).boundary()) {
  const scene::Accelerator& accelerator = scene.accelerator(region);
  for (const scene::BoundingPlane& plane : boundary_->planes) {
    list_.push_back({plane.first, plane.triangles_begin != plane.triangles_end});
    const core::Vec3 normal = scene.normal(region, plane.first);
    normals_.push_back({{normal.x(), normal.y(), normal.z(), 0.0}});
  }
  if (!accelerator.is_convex_body()) return;
  const scene::ExactBodies& exact = boundary_->exact;
  const scene::ExactBody& body = exact.bodies.front();
  const auto add = [&](const auto& face) {
    const scene::SurfaceTriangles& on = face.on;
    list_.push_back({on.first == scene::kNoSurface ? body.first : on.first, on.begin != on.end});
    numbers_.push_back(numbers_of(face));
  };
  for (std::uint32_t i = body.planes_begin; i < body.planes_end; ++i) add(exact.planes[i]);
  flat_ = body.planes_end - body.planes_begin;
  cylinders_ = accelerator.is_convex_cylinders();
  for (std::uint32_t i = body.quadrics_begin; i < body.quadrics_end; ++i) add(exact.quadrics[i]);
}

void LaneFaces::set_optics(const scene::Scene& scene, const source::Photon& photon, bool refracts,
                           Optics optics) const {
  const scene::Region& region = scene.regions[photon.region];
  const scene::BoundaryLink* const links = scene.links_of(region);
  refracts = refracts && !has_quadrics() && !scene.keeps_phases && scene.optics.birefringent.empty() &&
             !region.thin_gaps;
  core::MediumId known_medium;
  double known_sin2 = kNoTotalReflection, known_index = 0.0;
  for (const Face& face : list_) {
    if (face.mixed) {
      *optics.least_sin2++ = kManyRegions;
      *optics.index_behind++ = 0.0;
      continue;
    }
    const core::MediumId medium = links[face.triangle].smooth_to;
    if (medium != known_medium) {
      known_medium = medium;
      known_sin2 = critical_sin2(scene, medium, photon);
      const bool transparent = medium.has_value() && !scene.optics.is_opaque(medium);
      known_index = transparent ? scene.optics.index(medium, photon.wavelength_nm) : 0.0;
    }
    *optics.least_sin2++ = known_sin2;
    *optics.index_behind++ = refracts ? known_index : 0.0;
  }
}

LanePlanes LaneFaces::planes() const {
  using Plane = scene::BoundingPlane;
  static_assert(std::is_standard_layout_v<Plane> && offsetof(Plane, normal) == 0 &&
                offsetof(Plane, offset) == 3 * sizeof(double) && sizeof(Plane) % sizeof(double) == 0);
  return {reinterpret_cast<const double*>(boundary_->planes.data()), sizeof(Plane) / sizeof(double),
          static_cast<std::uint32_t>(boundary_->planes.size()), boundary_->opposite_planes,
          boundary_->is_box};
}

LaneBody LaneFaces::body() const {
  return {numbers_.data(), flat_, static_cast<std::uint32_t>(numbers_.size()), cylinders_};
}

double LaneFaces::left_at(std::uint32_t triangle) const {
  if (triangle == scene::kNoTriangle || numbers_.empty()) return kNoFace;
  const scene::ExactBodies& exact = boundary_->exact;
  const std::uint32_t quadric = exact.quadric_of[triangle];
  if (quadric == scene::kNoSurface) return kNoFace;
  return static_cast<double>(flat_ + quadric - exact.bodies.front().quadrics_begin);
}

}  // namespace scintray::transport
