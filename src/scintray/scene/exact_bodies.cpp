#include "scintray/scene/exact_bodies.hpp"

namespace scintray::scene {

namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr Chord kNoChord{kUnbounded, -kUnbounded};

/// Position of a cone's tip along its axis, from the origin, which is on the other side of the plane of 0.
double tip_of(const mesh::SupportSurface& s) { return s.slope / s.axial; }

bool is_inside(const mesh::SupportSurface& s, const core::Vec3& point) {
  if (s.value(point) > 0.0) return false;
  return s.axial >= 0.0 || (s.axis.dot(point - s.origin) - tip_of(s)) * tip_of(s) <= 0.0;
}

}  // namespace

Chord chord_in(const mesh::SupportSurface& s, const QuadricOnRay& q, const core::Vec3& origin,
               const core::Vec3& direction) {
  const double discriminant = q.b * q.b - q.a * q.c;
  const bool cone = s.axial < 0.0;
  // Cones: towards the origin's side of the tip.
  const double opening = cone && tip_of(s) > 0.0 ? -1.0 : 1.0;
  if (q.a > 0.0) {
    if (!(discriminant > 0.0)) return kNoChord;
    const double middle = -q.b / q.a;
    if (cone && (s.axis.dot(origin + middle * direction - s.origin) - tip_of(s)) * opening < 0.0)
      return kNoChord;
    const double sum = -(q.b + std::copysign(std::sqrt(discriminant), q.b));
    const double one = sum / q.a, other = q.c / sum;
    return {std::min(one, other), std::max(one, other)};
  }
  const double ahead = cone ? s.axis.dot(direction) * opening : 0.0;
  if (q.a < 0.0) {  // along a cone: inside from one root on, or up to the other
    const double sum = -(q.b + std::copysign(std::sqrt(std::max(0.0, discriminant)), q.b));
    if (sum == 0.0) return ahead > 0.0 ? Chord{0.0, kUnbounded} : Chord{-kUnbounded, 0.0};
    const double one = sum / q.a, other = q.c / sum;
    return ahead > 0.0 ? Chord{std::max(one, other), kUnbounded} : Chord{-kUnbounded, std::min(one, other)};
  }
  if (q.b == 0.0) return q.c <= 0.0 ? Chord{} : kNoChord;
  const double root = -0.5 * q.c / q.b;
  return q.b > 0.0 ? Chord{-kUnbounded, root} : Chord{root, kUnbounded};
}

bool ExactBodies::contains(const ExactBody& body, const core::Vec3& point) const {
  if (!body.is_convex()) return encloses(body, point);
  for (std::uint32_t i = body.planes_begin; i < body.planes_end; ++i)
    if (planes[i].normal.dot(point) > planes[i].offset) return false;
  for (std::uint32_t i = body.quadrics_begin; i < body.quadrics_end; ++i)
    if (!is_inside(quadrics[i].surface, point)) return false;
  return true;
}

bool ExactBodies::admit(const core::Vec3& point) const {
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (contains(bodies[i], point) != (held && i == 0)) return false;
  return true;
}

void ExactBodies::leave(const ExactBody& body, const Ray& ray, BodyHit& nearest) const {
  for (std::uint32_t i = body.planes_begin; i < body.planes_end; ++i) {
    const BodyPlane& plane = planes[i];
    const double along = plane.normal.dot(ray.direction);
    if (along <= 0.0) continue;
    const double distance = std::max(0.0, (plane.offset - plane.normal.dot(ray.origin)) / along);
    if (distance < nearest.distance_mm) nearest = {distance, &plane.on, body.first};
  }
  for (std::uint32_t i = body.quadrics_begin; i < body.quadrics_end; ++i) {
    const BodyQuadric& quadric = quadrics[i];
    QuadricOnRay q = on_ray(quadric.surface, ray.origin, ray.direction);
    if (i == ray.left) q.c = 0.0;
    const double distance = mesh::distance_out(q);
    if (distance < nearest.distance_mm) nearest = {distance, &quadric.on, body.first};
  }
}

void ExactBodies::enter(std::uint32_t number, const Ray& ray, BodyHit& nearest) const {
  const ExactBody& body = bodies[number];
  double near = 0.0, far = nearest.distance_mm;
  if (!reaches(body.low, body.high, ray.origin, ray.inverse, near, far)) return;
  if (!body.is_convex()) return cross_faces(number, false, ray, nearest);
  Chord chord;
  const SurfaceTriangles* entered = nullptr;
  for (std::uint32_t i = body.planes_begin; i < body.planes_end; ++i) {
    const BodyPlane& plane = planes[i];
    const double cosine = plane.normal.dot(ray.direction),
                 ahead = plane.offset - plane.normal.dot(ray.origin);
    if (cosine == 0.0) {
      if (ahead < 0.0) return;
      continue;
    }
    const double distance = ahead / cosine;
    if (cosine > 0.0) {
      chord.high = std::min(chord.high, distance);
    } else if (distance > chord.low) {
      chord.low = distance;
      entered = &plane.on;
    }
  }
  for (std::uint32_t i = body.quadrics_begin; i < body.quadrics_end; ++i) {
    const BodyQuadric& quadric = quadrics[i];
    QuadricOnRay q = on_ray(quadric.surface, ray.origin, ray.direction);
    if (i == ray.left) q.c = 0.0;
    const Chord in = chord_in(quadric.surface, q, ray.origin, ray.direction);
    chord.high = std::min(chord.high, in.high);
    if (in.low > chord.low) {
      chord.low = in.low;
      entered = &quadric.on;
    }
    if (!(chord.low < chord.high)) return;
  }
  // From outside, a chord around the start means that the start is on the body, at the nearer end.
  if (!(chord.low < chord.high) || chord.high <= 0.0 || !entered) return;
  if (chord.low < 0.0 && -chord.low >= chord.high) return;
  const double distance = std::max(0.0, chord.low);
  // Of coinciding ends of nested bodies, the smaller body's counts, which has the higher number.
  if (distance < nearest.distance_mm || (distance == nearest.distance_mm && number > nearest.body))
    nearest = {distance, entered, body.first, number};
}

void ExactBodies::enter_any(const Ray& ray, BodyHit& nearest) const {
  std::array<std::uint32_t, 64> waiting{};  // more than the depth of a tree that is cut in halves
  std::size_t count = 1;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const BodyNode& node = nodes[at];
    double near = 0.0, far = nearest.distance_mm;
    if (!reaches(node.low, node.high, ray.origin, ray.inverse, near, far)) continue;
    for (std::uint32_t i = node.begin; i < node.end; ++i) enter(in_leaves[i], ray, nearest);
    if (node.begin != node.end) continue;
    waiting[count++] = node.second;
    waiting[count++] = at + 1;
  }
}

BodyHit ExactBodies::nearest(const core::Vec3& origin, const core::Vec3& direction,
                             std::uint32_t left) const {
  Ray ray{origin, direction, direction, left};
  BodyHit hit;
  if (held && bodies.front().is_convex()) {
    leave(bodies.front(), ray, hit);
    if (bodies.size() == 1) return hit;
  }
  ray.inverse = direction.cwiseInverse();
  if (held && !bodies.front().is_convex()) cross_faces(0, true, ray, hit);
  if (!nodes.empty()) {
    enter_any(ray, hit);
    return hit;
  }
  for (auto i = static_cast<std::uint32_t>(held); i < bodies.size(); ++i) enter(i, ray, hit);
  return hit;
}

}  // namespace scintray::scene
