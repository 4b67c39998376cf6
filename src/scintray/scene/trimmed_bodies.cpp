#include "scintray/scene/detail/surface_roots.hpp"

namespace scintray::scene {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

double distance_from_trim(const ExactBodies& exact, const Trim& trim, const core::Vec3& point) {
  return std::abs(trim.surface == kNoSurface ? trim.normal.dot(point) - trim.offset
                                             : exact.trim_surfaces[trim.surface].distance(point));
}

}  // namespace

const SurfaceTriangles& ExactBodies::triangles_of(const TrimmedFace& face) const {
  return face.plane != kNoSurface ? planes[face.plane].on : quadrics[face.quadric].on;
}

const TrimBox* ExactBodies::box_at(const TrimGrid& grid, const core::Vec3& point) const {
  std::size_t number = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const std::uint32_t count = grid.count[static_cast<std::size_t>(axis)];
    const double at = (point[axis] - grid.low[axis]) * grid.per_mm[axis];
    if (!(at >= 0.0 && at < count)) return nullptr;
    number = number * count + static_cast<std::size_t>(at);
  }
  return &trim_boxes[grid.first + number];
}

bool ExactBodies::is_within(const TrimmedFace& face, const core::Vec3& point) const {
  const auto is_kept_by = [&](const Trim& trim) { return (value_of(trim, point) > 0.0) == trim.above; };
  if (face.grid != kNoSurface) {
    if (const TrimBox* box = box_at(trim_grids[face.grid], point)) {
      if (box->begin == kNoSurface) return false;
      for (std::uint32_t i = box->begin; i < box->end; ++i)
        if (!is_kept_by(trims[asked_trims[i]])) return false;
      return true;
    }
  }
  if (face.cells_begin == face.cells_end) {
    for (std::uint32_t i = face.trims_begin; i < face.trims_end; ++i)
      if (!is_kept_by(trims[i])) return false;
    return true;
  }
  std::uint64_t signs = 0;
  for (std::uint32_t i = face.trims_begin; i < face.trims_end; ++i)
    if (value_of(trims[i], point) > 0.0) signs |= std::uint64_t{1} << (i - face.trims_begin);
  return std::binary_search(cells.begin() + face.cells_begin, cells.begin() + face.cells_end, signs);
}

double ExactBodies::distance_from_outline(const TrimmedFace& face, const core::Vec3& point) const {
  double outside_box = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    outside_box = std::max({outside_box, face.low[axis] - point[axis], point[axis] - face.high[axis]});
  const auto off_cell = [&](auto is_above) {
    double off = 0.0;
    for (std::uint32_t i = face.trims_begin; i < face.trims_end; ++i)
      if ((value_of(trims[i], point) > 0.0) != is_above(i))
        off = std::max(off, distance_from_trim(*this, trims[i], point));
    return off;
  };
  if (face.cells_begin == face.cells_end)
    return std::max(outside_box, off_cell([&](std::uint32_t i) { return trims[i].above; }));
  double least = kNever;
  for (std::uint32_t cell = face.cells_begin; cell < face.cells_end; ++cell)
    least = std::min(least, off_cell([&](std::uint32_t i) {
                       return ((cells[cell] >> (i - face.trims_begin)) & 1u) != 0;
                     }));
  return std::max(outside_box, least);
}

template <typename Consider>
void ExactBodies::for_each_crossing(const TrimmedFace& face, const Ray& ray, double low, double high,
                                    const Consider& consider) const {
  if (face.plane != kNoSurface) {
    const BodyPlane& plane = planes[face.plane];
    const double cosine = plane.normal.dot(ray.direction);
    if (cosine != 0.0) consider((plane.offset - plane.normal.dot(ray.origin)) / cosine, cosine > 0.0);
    return;
  }
  const mesh::SupportSurface& surface = quadrics[face.quadric].surface;
  const bool on_it = face.quadric == ray.left;
  const Crossings crossings = surface.is_torus()
                                  ? torus_crossings(surface, ray.origin, ray.direction, on_it, low, high)
                                  : quadric_crossings(on_ray(surface, ray.origin, ray.direction), on_it);
  for (const Crossing& crossing : crossings)
    if (surface.is_on_sheet(ray.origin + crossing.distance_mm * ray.direction))
      consider(crossing.distance_mm, crossing.leaves != face.wall);
}

void ExactBodies::cross_face(std::uint32_t number, const ExactBody& body, const Ray& ray,
                             const Wanted& wanted, FaceCrossing& nearest) const {
  const TrimmedFace& face = faces[number];
  double near = -body.rounding_mm, far = nearest.distance_mm;
  if (!reaches(face.low, face.high, ray.origin, ray.inverse, near, far)) return;
  const auto consider = [&](double distance, bool outwards) {
    if (!(distance >= near && distance <= far && distance < nearest.distance_mm)) return;
    if (outwards != wanted.outwards && distance <= wanted.others_from) return;
    if (is_within(face, ray.origin + distance * ray.direction)) nearest = {distance, number, outwards};
  };
  for_each_crossing(face, ray, near, far, consider);
}

ExactBodies::FaceCrossing ExactBodies::nearest_crossing(const ExactBody& body, const Ray& ray,
                                                        const Wanted& wanted, double limit) const {
  FaceCrossing nearest;
  nearest.distance_mm = limit;
  if (body.root == kNoSurface) {
    for (std::uint32_t i = body.faces_begin; i < body.faces_end; ++i)
      cross_face(i, body, ray, wanted, nearest);
    return nearest;
  }
  for (std::uint32_t i = body.large_begin; i < body.large_end; ++i)
    cross_face(faces_in_leaves[i], body, ray, wanted, nearest);
  std::array<std::uint32_t, 64> waiting;  // more than the depth of a tree that is cut in halves
  waiting[0] = body.root;
  std::size_t count = 1;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const BodyNode& node = face_nodes[at];
    double near = -body.rounding_mm, far = nearest.distance_mm;
    if (!reaches(node.low, node.high, ray.origin, ray.inverse, near, far)) continue;
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      cross_face(faces_in_leaves[i], body, ray, wanted, nearest);
    if (node.begin != node.end) continue;
    waiting[count++] = node.second;
    waiting[count++] = at + 1;
  }
  return nearest;
}

ExactBodies::FaceCrossing ExactBodies::search_faces(const ExactBody& body, const Ray& ray, bool outwards,
                                                    double limit) const {
  FaceCrossing best;
  double least_off = kNever;
  for (std::uint32_t i = body.faces_begin; i < body.faces_end; ++i) {
    const TrimmedFace& face = faces[i];
    const auto consider = [&](double distance, bool leads_out) {
      if (leads_out != outwards || !(distance >= -body.off_surface_mm && distance <= limit)) return;
      const double off = distance_from_outline(face, ray.origin + distance * ray.direction);
      if (off > least_off || (off == least_off && distance >= best.distance_mm)) return;
      least_off = off;
      best = {distance, i, outwards};
    };
    const double size = (body.high - body.low.vec()).norm() + (ray.origin - body.low.vec()).norm();
    for_each_crossing(face, ray, -size, size, consider);
  }
  return best;
}

void ExactBodies::cross_faces(std::uint32_t number, bool outwards, const Ray& ray, BodyHit& nearest) const {
  const ExactBody& body = bodies[number];
  constexpr int kMostFromBeside = 8;
  Wanted wanted{outwards, body.rounding_mm};
  FaceCrossing crossing;
  bool resolved = false;
  for (int beside = 0;; ++beside) {
    crossing = nearest_crossing(body, ray, wanted, outwards ? kNever : nearest.distance_mm);
    if (crossing.face == kNoSurface) {
      if (!outwards) return;
      crossing = search_faces(body, ray, outwards, kNever);
      resolved = true;
      break;
    }
    if (crossing.outwards == outwards) break;
    // From beside the face: a ray that has come through the face of another body there, within tolerance.
    const TrimmedFace& face = faces[crossing.face];
    const double off = face.plane != kNoSurface
                           ? planes[face.plane].offset - planes[face.plane].normal.dot(ray.origin)
                           : quadrics[face.quadric].surface.distance(ray.origin);
    if (std::abs(off) <= body.off_surface_mm && beside < kMostFromBeside) {
      wanted.others_from = std::max(crossing.distance_mm, wanted.others_from);
      continue;
    }
    crossing = search_faces(body, ray, outwards, crossing.distance_mm);
    resolved = true;
    break;
  }
  if (crossing.face == kNoSurface) return;
  const double distance = std::max(0.0, crossing.distance_mm);
  if (distance < nearest.distance_mm ||
      (!outwards && distance == nearest.distance_mm && number > nearest.body))
    nearest = {distance, &triangles_of(faces[crossing.face]), body.first, number, resolved};
}

bool ExactBodies::encloses(const ExactBody& body, const core::Vec3& point) const {
  for (int axis = 0; axis < 3; ++axis)
    if (point[axis] < body.low[axis] || point[axis] > body.high[axis]) return false;
  // By the nearest face along most of three skew directions.
  static const std::array<core::Vec3, 3> kSkew{core::Vec3(0.57128349, 0.31415927, 0.75829143).normalized(),
                                               core::Vec3(-0.26120387, 0.81649658, -0.51471863).normalized(),
                                               core::Vec3(0.12345679, -0.67823299, -0.72443281).normalized()};
  int inside = 0;
  for (const core::Vec3& direction : kSkew) {
    const Ray ray{point, direction, direction.cwiseInverse(), kNoSurface};
    const FaceCrossing crossing = nearest_crossing(body, ray, {true, 0.0}, kNever);
    inside += crossing.face != kNoSurface && crossing.outwards;
  }
  return inside >= 2;
}

bool ExactBodies::alternates(const ExactBody& body, core::Vec3 origin, const core::Vec3& direction) const {
  bool inside = false;
  for (;;) {
    const Ray ray{origin, direction, direction.cwiseInverse(), kNoSurface};
    const FaceCrossing crossing = nearest_crossing(body, ray, {inside, body.rounding_mm}, kNever);
    if (crossing.face == kNoSurface) return !inside;
    if (crossing.outwards != inside) return false;
    inside = !inside;
    origin += (crossing.distance_mm + 0.5 * body.rounding_mm) * direction;
  }
}

double ExactBodies::distance_to_faces(const ExactBody& body, const core::Vec3& point) const {
  double least = kNever;
  for (std::uint32_t i = body.faces_begin; i < body.faces_end; ++i) {
    const TrimmedFace& face = faces[i];
    double off;
    core::Vec3 foot = point;
    if (face.plane != kNoSurface) {
      off = planes[face.plane].normal.dot(point) - planes[face.plane].offset;
      foot -= off * planes[face.plane].normal.vec();
    } else {
      const mesh::SupportSurface& surface = quadrics[face.quadric].surface;
      off = surface.distance(point);
      for (int step = 0; step < 3; ++step) foot += surface.correction(foot);
    }
    if (std::abs(off) < least && distance_from_outline(face, foot) == 0.0) least = std::abs(off);
  }
  return least;
}

}  // namespace scintray::scene
