#include "scintray/scene/accelerator.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/mesh/cylinder_arrival.hpp"
#include "scintray/mesh/triangle_distance.hpp"
#include "scintray/scene/detail/nearest_plane.hpp"

namespace scintray::scene {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Distance from the origin at which rays start, relative to the region's size, so that they do not hit the
/// triangle of their origin; single precision resolves about 1e-7.
constexpr double kStartAhead = 1e-6;
/// Distance behind its start, relative to the region's size, at which a ray may already have left the region.
constexpr double kBehind = 1e-5;
/// Barycentric distance from a triangle's edges beyond which a hit in single precision is certain.
constexpr float kClearOfEdge = 1e-4f;
/// Number of facets of one round face from which they are found by Embree.
constexpr std::uint32_t kManyFacets = 16;
/// Number of hits on the plane that the ray starts from inwards that are skipped before the exact query.
constexpr int kMostSelfHits = 2;

/// Single rays do not profit from the widest vectors, which lower the clock frequency: with them a step in a
/// box takes 3 % longer (tools/bench --scene polished_embree), one in a million triangles as long.
constexpr const char* kDevice = "set_affinity=0,max_isa=avx2";

/// Number of triangles from which Embree builds its hierarchy without splitting them.
constexpr std::size_t kManyTriangles = 200'000;

/// Distance (mm) in the plane from `point` to the triangle; 0 inside.
double distance_outside(const BoundaryTriangle& triangle, const core::Vec3& normal, const core::Vec3& point) {
  double outside = 0.0;
  for (int i = 0; i < 3; ++i) {
    const core::Vec3& a = triangle[static_cast<std::size_t>(i)];
    const core::Vec3& b = triangle[static_cast<std::size_t>((i + 1) % 3)];
    const core::Vec3 edge = b - a;
    const double beyond = -normal.cross(edge).dot(point - a);
    if (beyond > 0.0) outside = std::max(outside, mesh::distance_to_segment(point, a, b));
  }
  return outside;
}

#if defined(RTC_VERSION_MAJOR) && RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& hit) { rtcIntersect1(scene, &hit); }
#else
void intersect(RTCScene scene, RTCRayHit& hit) {
  RTCIntersectContext context;  // NOLINT(cppcoreguidelines-pro-type-member-init): the next line does it
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
}
#endif

/// Embree reads the ray by fours: behind single stores its first instruction would wait until these have left
/// the processor's store buffer (3 % of a step in a box).
RTCRayHit make_ray(core::FourFloats origin_and_start, core::FourFloats direction_and_time) {
  static_assert(offsetof(RTCRay, tnear) == 3 * sizeof(float) &&
                offsetof(RTCRay, time) == offsetof(RTCRay, dir_x) + 3 * sizeof(float));
  RTCRayHit hit;  // NOLINT(cppcoreguidelines-pro-type-member-init): what Embree does not read stays as it is
  std::memcpy(&hit.ray.org_x, &origin_and_start, sizeof origin_and_start);
  std::memcpy(&hit.ray.dir_x, &direction_and_time, sizeof direction_and_time);
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = 0xffffffffu;
  hit.ray.flags = 0;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return hit;
}

RTCRayHit make_ray(const core::Vec3& origin, const core::Vec3& direction, double start) {
  return make_ray(core::Lanes(origin, start).floats(), core::Lanes(direction, 0.0).floats());
}

/// The Embree device of all accelerators of the process, which owns threads and settings but no scene.
/// Started on first use, by one thread only; released after the last scene that refers to it, and not before
/// the process ends.
std::shared_ptr<RTCDeviceTy> embree_device() {
  static const std::shared_ptr<RTCDeviceTy> device = [] {
    const RTCDevice started = rtcNewDevice(kDevice);
    if (!started)
      throw core::SystemError(rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY
                                  ? "out of memory while Embree, the library of ray queries, was started"
                                  : "Embree, the library of ray queries, cannot be started on this machine");
    return std::shared_ptr<RTCDeviceTy>(started, rtcReleaseDevice);
  }();
  return device;
}

}  // namespace

struct Accelerator::EmbreeScene {
  std::shared_ptr<RTCDeviceTy> shared_device = embree_device();
  RTCScene scene = nullptr;

  /// @param corners  three a triangle, indices into `points`
  EmbreeScene(const std::vector<core::PlainVec3>& points, std::span<const std::uint32_t> corners) {
    const RTCDevice device = shared_device.get();
    const std::size_t size = corners.size() / 3;
    scene = rtcNewScene(device);
    // Splitting triangles for a better hierarchy takes much memory for large meshes.
    rtcSetSceneBuildQuality(scene, size > kManyTriangles ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), size));
    if (!vertices || !indices) throw core::SystemError("Embree could not allocate its mesh buffers");
    for (const core::PlainVec3& vertex : points)
      for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(vertex[axis]);
    std::copy(corners.begin(), corners.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw core::SystemError(error == RTC_ERROR_OUT_OF_MEMORY
                                  ? "out of memory while Embree built its hierarchy of triangles"
                                  : "Embree could not build its hierarchy (error " + std::to_string(error) +
                                        ")");
  }
  ~EmbreeScene() {
    if (scene) rtcReleaseScene(scene);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
};

Accelerator::Accelerator(const std::vector<BoundaryTriangle>& triangles,
                         const std::vector<std::uint32_t>& labels, bool closed,
                         scene_file::AcceleratorKind kind, ExactBodies exact)
    : Accelerator(make_boundary(triangles, labels, closed, kind, std::move(exact))) {}

Accelerator::Accelerator(Boundary boundary)
    : boundary_(std::move(boundary)), start_mm_(kStartAhead * boundary_.size_mm) {
  if (boundary_.meshed() > 0 && boundary_.planes.empty())
    embree_ = std::make_unique<EmbreeScene>(boundary_.vertices,
                                            boundary_.merged.empty()
                                                ? std::span(boundary_.corners).first(3 * boundary_.meshed())
                                                : std::span(std::as_const(boundary_.merged.corners)));
  index_facets();
  const std::vector<BodyQuadric>& quadrics = boundary_.exact.quadrics;
  convex_cylinders_ = is_convex_body() && !quadrics.empty() &&
                      std::all_of(quadrics.begin(), quadrics.end(),
                                  [](const BodyQuadric& quadric) { return quadric.surface.is_cylinder(); });
}

Accelerator::~Accelerator() = default;

Exit Accelerator::find_exit(const core::Vec3& origin, const core::Vec3& direction) const {
  if (!boundary_.planes.empty()) return exit_by_planes(origin, direction);
  if (has_exact_bodies()) return find_exact_exit(origin, direction, kNoTriangle);
  return exit_by_embree(origin, direction);
}

Exit Accelerator::exit_by_embree(const core::Vec3& origin, const core::Vec3& direction) const {
  if (!embree_) return {};
  const core::Lanes from(origin, -1.0), along(direction, 0.0);
  const FirstHit hit = first_hit(core::Lanes(origin, start_mm_).floats(), along.floats());
  if (hit.triangle != kNoTriangle) {
    const Approach approach = approach_of(hit.triangle, from, along);
    if (approach.cosine > 0.0) return {approach.distance_mm, hit.triangle, false};
  }
  return exact_exit(origin, direction, hit);
}

Exit Accelerator::exit_across_gap(const core::Vec3& origin, const core::Vec3& direction,
                                  std::uint32_t left) const {
  const ThinGaps& thin = boundary_.thin_gaps;
  const ThinGaps::Range range = thin.of_triangle[left];
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    const ThinGap& gap = thin.gaps[i];
    const double x = product(gap.x, origin), y = product(gap.y, origin);
    if (!gap.contains(x, y)) continue;
    const Approach approach = approach_of(gap.beyond, core::Lanes(origin, -1.0), core::Lanes(direction, 0.0));
    if (!(approach.cosine > 0.0)) break;
    if (gap.contains(x + approach.distance_mm * product(gap.x, direction),
                     y + approach.distance_mm * product(gap.y, direction)))
      return {approach.distance_mm, gap.beyond, false};
  }
  return {};
}

Exit Accelerator::exit_by_planes(const core::Vec3& origin, const core::Vec3& direction) const {
  const PlaneAhead ahead = nearest_plane(boundary_, origin, direction);
  const BoundingPlane* const exit = &boundary_.planes[ahead.plane];
  const double nearest = std::max(ahead.distance_mm, 0.0);
  std::uint32_t triangle = exit->first;
  if (exit->triangles_begin != exit->triangles_end) {
    const core::Vec3 point = origin + nearest * direction;
    double least_outside = kInfinity;
    for (std::uint32_t i = exit->triangles_begin; i < exit->triangles_end; ++i) {
      const std::uint32_t candidate = boundary_.plane_triangles[i];
      const double outside = distance_outside(boundary_.triangle(candidate), normal(candidate), point);
      if (outside >= least_outside) continue;
      least_outside = outside;
      triangle = candidate;
      if (outside == 0.0) break;
    }
  }
  return {nearest, triangle, false};
}

Exit Accelerator::find_exact_exit(const core::Vec3& origin, const core::Vec3& direction,
                                  std::uint32_t left) const {
  const ExactBodies& exact = boundary_.exact;
  const BodyHit hit =
      exact.nearest(origin, direction, left == kNoTriangle ? kNoSurface : exact.quadric_of[left]);
  if (embree_) {
    const Exit meshed = exit_by_embree(origin, direction);
    if (meshed.triangle != kNoTriangle && meshed.distance_mm < hit.distance_mm) return meshed;
  }
  if (!hit.on) return {};
  return {hit.distance_mm, triangle_at(hit, origin + hit.distance_mm * direction), hit.resolved};
}

void Accelerator::index_facets() {
  const ExactBodies& exact = boundary_.exact;
  facets_.resize(exact.quadrics.size());
  for (std::size_t i = 0; i < exact.quadrics.size(); ++i) {
    const SurfaceTriangles& on = exact.quadrics[i].on;
    if (on.end - on.begin < kManyFacets) continue;
    std::vector<std::uint32_t> corners;
    for (std::uint32_t k = on.begin; k < on.end; ++k)
      for (std::uint32_t corner = 0; corner < 3; ++corner)
        corners.push_back(boundary_.corners[3 * exact.triangles[k] + corner]);
    facets_[i] = std::make_unique<EmbreeScene>(boundary_.vertices, corners);
  }
}

std::uint32_t Accelerator::triangle_at(const BodyHit& hit, const core::Vec3& point) const {
  const SurfaceTriangles& on = *hit.on;
  if (on.begin == on.end) return on.first == kNoSurface ? hit.first : on.first;
  const ExactBodies& exact = boundary_.exact;
  for (std::uint32_t i = on.outlines_begin; i < on.outlines_end; ++i) {
    const EndOutline& outline = exact.outlines[i];
    if (outline.face != kNoSurface) {
      const TrimmedFace& face = exact.faces[outline.face];
      const bool beside =
          (point.array() < face.low.vec().array()).any() || (point.array() > face.high.vec().array()).any();
      if (!beside && exact.is_within(face, point)) return outline.triangle;
      continue;
    }
    if (std::all_of(exact.outline_of.begin() + outline.quadrics_begin,
                    exact.outline_of.begin() + outline.quadrics_end,
                    [&](const mesh::SupportSurface& surface) { return surface.value(point) <= 0.0; }))
      return outline.triangle;
  }
  const std::uint32_t quadric = exact.quadric_of[on.first];
  if (quadric != kNoSurface) return facet_at(quadric, point);
  return nearest_of(on, [&](std::uint32_t candidate) {
    return distance_outside(boundary_.triangle(candidate), normal(candidate), point);
  });
}

template <typename Outside>
std::uint32_t Accelerator::nearest_of(const SurfaceTriangles& on, Outside outside_of) const {
  std::uint32_t nearest = on.first;
  double least_outside = kInfinity;
  for (std::uint32_t i = on.begin; i < on.end; ++i) {
    const std::uint32_t candidate = boundary_.exact.triangles[i];
    const double outside = outside_of(candidate);
    if (outside >= least_outside) continue;
    least_outside = outside;
    nearest = candidate;
    if (outside == 0.0) break;
  }
  return nearest;
}

std::uint32_t Accelerator::facet_at(std::uint32_t quadric, const core::Vec3& point) const {
  const SurfaceTriangles& on = boundary_.exact.quadrics[quadric].on;
  const core::Vec3 from = boundary_.exact.quadrics[quadric].surface.middle(point), along = point - from;
  if (facets_[quadric]) {
    RTCRayHit hit = make_ray(from, along, 0.0);
    intersect(facets_[quadric]->scene, hit);
    if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID)
      return boundary_.exact.triangles[on.begin + hit.hit.primID];
  }
  return nearest_of(on, [&](std::uint32_t candidate) {
    const TrianglePlane& plane = boundary_.triangle_planes[candidate];
    const double cosine = plane.normal.dot(along), ahead = plane.offset - plane.normal.dot(from);
    if (!(ahead * cosine > 0.0)) return kInfinity;
    return distance_outside(boundary_.triangle(candidate), plane.normal, from + ahead / cosine * along);
  });
}

core::Vec3 Accelerator::normal_at(std::uint32_t triangle, const core::Vec3& point) const {
  return boundary_.exact.empty() ? core::Vec3(normal(triangle)) : nearest_at(triangle, point).normal;
}

namespace {

mesh::Foot arrival_on(const mesh::SupportSurface& cylinder, const core::Vec3& point) {
  const mesh::FootOf<double> foot =
      mesh::arrival_on_cylinder(cylinder.numbers<mesh::QuadricShape::cylinder>(),
                                Accelerator::inverse_radius(cylinder), core::triple(point));
  return {core::vec(foot.step), core::vec(foot.normal)};
}

}  // namespace

mesh::Foot Accelerator::nearest_at(std::uint32_t triangle, const core::Vec3& point) const {
  const std::uint32_t quadric = boundary_.exact.quadric_of[triangle];
  if (quadric == kNoSurface) return {core::Vec3::Zero(), normal(triangle)};
  const mesh::SupportSurface& surface = boundary_.exact.quadrics[quadric].surface;
  mesh::Foot nearest = convex_cylinders_ ? arrival_on(surface, point) : surface.nearest(point);
  if (!boundary_.exact.quadrics[quadric].around_region) nearest.normal = -nearest.normal;
  return nearest;
}

FirstHit Accelerator::first_hit(core::FourFloats origin_and_start, core::FourFloats direction) const {
  RTCRayHit hit = make_ray(origin_and_start, direction);
  intersect(embree_->scene, hit);
  return {hit.ray.tfar, 0.0f,
          hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kNoTriangle : searched(hit.hit.primID), 0};
}

Exit Accelerator::exact_exit(const core::Vec3& origin, const core::Vec3& direction, FirstHit hit) const {
  for (int self_hits = 0;; ++self_hits) {
    if (hit.triangle == kNoTriangle) {
      if (!boundary_.closed) return {};
      break;
    }
    const Approach approach =
        approach_of(hit.triangle, core::Lanes(origin, -1.0), core::Lanes(direction, 0.0));
    if (approach.cosine > 0.0) return {approach.distance_mm, hit.triangle, false};
    const TrianglePlane& plane = boundary_.triangle_planes[hit.triangle];
    const double ahead = plane.offset - plane.normal.dot(origin);
    if (self_hits == kMostSelfHits || std::abs(ahead) > start_mm_) break;
    const double start = std::nextafter(hit.distance_mm, std::numeric_limits<float>::infinity()) + start_mm_;
    hit = first_hit(core::Lanes(origin, start).floats(), core::Lanes(direction, 0.0).floats());
  }
  return exit_by_search(origin, direction);
}

Exit Accelerator::exit_by_search(const core::Vec3& origin, const core::Vec3& direction) const {
  const double behind = kBehind * boundary_.size_mm;
  double entered = kInfinity;  // where the ray would re-enter from outside
  for (std::uint32_t i = 0; i < boundary_.meshed(); ++i) {
    if (normal(i).dot(direction) >= 0.0) continue;
    const double distance = distance_to_plane(i, origin, direction);
    if (distance > behind && distance < entered &&
        distance_outside(triangle(i), normal(i), origin + distance * direction) == 0.0)
      entered = distance;
  }
  // The nearest triangle hit or, without one, the triangle missed by the least distance.
  Exit exit{0.0, kNoTriangle, true};
  double least_miss = kInfinity;
  for (std::uint32_t i = 0; i < boundary_.meshed(); ++i) {
    if (normal(i).dot(direction) <= 0.0) continue;
    const double distance = distance_to_plane(i, origin, direction);
    if (!(distance >= -behind && distance <= entered + behind)) continue;
    const double outside = distance_outside(triangle(i), normal(i), origin + distance * direction);
    const double miss = outside + (distance < -kCoplanar * boundary_.size_mm ? -distance : 0.0);
    if (miss < least_miss || (miss == least_miss && distance < exit.distance_mm)) {
      least_miss = miss;
      exit.distance_mm = distance;
      exit.triangle = i;
    }
  }
  // A ray leaves an unbounded region to infinity unless it passed through an edge.
  if (!boundary_.closed && least_miss > behind) return {0.0, kNoTriangle, true};
  exit.distance_mm = std::max(0.0, exit.distance_mm);
  return exit;
}

bool Accelerator::contains(const core::Vec3& point) const {
  if (!boundary_.planes.empty())
    return std::all_of(boundary_.planes.begin(), boundary_.planes.end(),
                       [&](const BoundingPlane& plane) { return plane.normal.dot(point) <= plane.offset; });
  if (has_exact_bodies()) {
    if (!boundary_.exact.admit(point)) return false;
  }
  if (!embree_) return !boundary_.closed;
  // A skew direction avoids the edges of axis-aligned meshes.
  static const core::Vec3 kSkew = core::Vec3(0.57128349, 0.31415927, 0.75829143).normalized();
  const auto ahead = inside_by_embree(point, kSkew);
  if (ahead == Inside::yes || ahead == Inside::no) return ahead == Inside::yes;
  const auto behind = inside_by_embree(point, -kSkew);
  if (behind == Inside::yes || behind == Inside::no) return behind == Inside::yes;
  if (ahead == Inside::no_hit && behind == Inside::no_hit) return !boundary_.closed;
  return inside_by_search(point, kSkew);
}

Accelerator::Inside Accelerator::inside_by_embree(const core::Vec3& point,
                                                  const core::Vec3& direction) const {
  RTCRayHit hit = make_ray(point, direction, 0.0);
  intersect(embree_->scene, hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Inside::no_hit;
  // Near the start or near an edge the side of the hit is uncertain in single precision.
  const float edge = std::min({hit.hit.u, hit.hit.v, 1.0f - hit.hit.u - hit.hit.v});
  if (hit.ray.tfar < kBehind * boundary_.size_mm || edge < kClearOfEdge) return Inside::unclear;
  return normal(searched(hit.hit.primID)).dot(direction) > 0.0 ? Inside::yes : Inside::no;
}

bool Accelerator::inside_by_search(const core::Vec3& point, const core::Vec3& direction) const {
  double nearest = kInfinity;
  bool inside = false;
  for (std::uint32_t i = 0; i < boundary_.meshed(); ++i) {
    const double along = normal(i).dot(direction);
    if (along == 0.0) continue;
    const double distance = distance_to_plane(i, point, direction);
    if (distance < 0.0 || distance >= nearest) continue;
    if (distance_outside(triangle(i), normal(i), point + distance * direction) > 0.0) continue;
    nearest = distance;
    inside = along > 0.0;
  }
  return inside;
}

}  // namespace scintray::scene
