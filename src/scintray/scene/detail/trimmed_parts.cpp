#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scintray/mesh/triangle_distance.hpp"
#include "scintray/scene/detail/arrangement.hpp"
#include "scintray/scene/detail/round_parts.hpp"

namespace scintray::scene {

namespace {

/// Sine of the angle between two faces below which they are tangent: exact edges of CAD files are off by
/// their tolerance, which turns tangent surfaces by up to this.
constexpr double kTangent = 0.03;
/// Number of cells' trims, and of trims of a face of one cell.
constexpr std::size_t kMostCellTrims = 64, kMostTrims = 1024;
/// Number of triangles of a face from which one point of each is enough.
constexpr std::size_t kManyTriangles = 2'000;
/// Points of a surface beyond each face that are compared with its triangles.
constexpr int kBeyond = 200;
/// Rays on which faces are to lead in and out in turn.
constexpr int kRays = 200;

double trim_value(const PartTrim& trim, const core::Vec3& point) {
  return trim.surface ? trim.surface->value(point) : trim.plane.normal.dot(point) - trim.plane.offset;
}
double trim_distance(const PartTrim& trim, const core::Vec3& point) {
  return trim.surface ? trim.surface->distance(point) : trim.plane.normal.dot(point) - trim.plane.offset;
}

/// The n-th point of a low-discrepancy sequence in the unit cube: multiples of powers of the root of
/// x^4 = x + 1 (M. Roberts 2018, a generalisation of the golden ratio).
core::Vec3 even_point(int n) {
  constexpr double kRoot = 1.22074408460575947536;
  core::Vec3 point;
  double power = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    power /= kRoot;
    const double sum = 0.5 + power * n;
    point[axis] = sum - std::floor(sum);
  }
  return point;
}

/// The edge between two faces.
struct SharedEdge {
  std::vector<std::array<core::Vec3, 2>> sides;

  std::vector<core::Vec3> points() const {
    std::vector<core::Vec3> result;
    for (const auto& [a, b] : sides) {
      result.push_back(a);
      result.push_back(b);
    }
    return result;
  }
};

PartTrim plane_trim(const core::Vec3& normal, const core::Vec3& through) {
  return {std::nullopt, {normal, normal.dot(through)}, false};
}

class TrimmedFaceFinder {
 public:
  TrimmedFaceFinder(const contact::PlacedPart& part, double tolerance_mm, PartBody& body)
      : part_(part), tolerance_(tolerance_mm), body_(body) {
    Eigen::AlignedBox3d box;
    for (const core::Vec3& vertex : part.vertices) box.extend(vertex);
    size_ = box.diagonal().norm();
  }

  std::string find() {
    std::string reason = assign_triangles();
    if (reason.empty()) reason = find_edges();
    for (std::size_t f = 0; reason.empty() && f < faces_.size(); ++f) {
      reason = trim(f);
      if (!reason.empty()) break;
      reason = check_beyond(f);
      if (reason.empty() || !trim_between_neighbours(f)) continue;
      reason = find_cells(faces_[f]);
      if (reason.empty()) reason = check_beyond(f);
    }
    if (!reason.empty()) return reason;
    for (Face& face : faces_) body_.faces.push_back(std::move(face.result));
    return check_rays();
  }

 private:
  struct Face {
    PartFace result;
    std::vector<std::size_t> triangles;
    std::vector<double> outline_off;  ///< of each trim: largest distance of the triangles' edge from it
    double off = 0.0;                 ///< largest distance of its facets from it, and of their edges
    double corners_off = 0.0;         ///< largest distance of its corners from it
  };

  Corners corners(std::size_t t) const {
    const auto& [a, b, c] = part_.triangles[t];
    return {part_.vertices[a], part_.vertices[b], part_.vertices[c]};
  }
  bool is_round(const Face& face) const { return face.result.quadric != kNoSurface; }
  const mesh::SupportSurface& surface(const Face& face) const { return body_.quadrics[face.result.quadric]; }

  core::Vec3 normal(const Face& face, const core::Vec3& point) const {
    if (!is_round(face)) return body_.planes[face.result.plane].normal;
    return surface(face).normal(point) * (face.result.wall ? -1.0 : 1.0);
  }
  core::Vec3 onto(const Face& face, core::Vec3 point) const {
    if (!is_round(face)) {
      const WorldPlane& plane = body_.planes[face.result.plane];
      return point - (plane.normal.dot(point) - plane.offset) * plane.normal;
    }
    for (int step = 0; step < 4; ++step) point += surface(face).correction(point);
    return point;
  }

  std::uint32_t plane_of(const Corners& t) const {
    const core::Vec3 area = doubled_area(t);
    const core::Vec3 normal = area.normalized();
    std::uint32_t best = kNoSurface;
    double least = HUGE_VAL;
    for (std::uint32_t i = 0; i < body_.planes.size(); ++i) {
      const WorldPlane& plane = body_.planes[i];
      double off = area.isZero(0.0) ? 0.0 : (plane.normal - normal).norm() * std::sqrt(area.norm());
      for (const core::Vec3& corner : t) off += std::abs(plane.normal.dot(corner) - plane.offset);
      if (off >= least) continue;
      least = off;
      best = i;
    }
    return best;
  }

  std::string assign_triangles() {
    std::map<std::pair<bool, std::uint32_t>, std::size_t> known;
    for (std::size_t t = 0; t < part_.triangles.size(); ++t) {
      const bool round = part_.support[t] != mesh::kNoSupport;
      const std::uint32_t number = round ? part_.support[t] : plane_of(corners(t));
      if (number == kNoSurface) return "it has no flat face of its own";
      const auto [at, is_new] = known.try_emplace({round, number}, faces_.size());
      if (is_new) {
        faces_.emplace_back();
        (round ? faces_.back().result.quadric : faces_.back().result.plane) = number;
      }
      Face& face = faces_[at->second];
      face_of_.push_back(at->second);
      face.triangles.push_back(t);
      for (const core::Vec3& corner : corners(t)) face.result.corners.push_back(corner);
      if (!round) continue;
      core::Vec3 outwards = core::Vec3::Zero();  // of a thin torus, the middle of a facet is beyond the tube
      for (const core::Vec3& corner : corners(t)) outwards += surface(face).gradient(corner);
      const bool wall = outwards.dot(doubled_area(corners(t))) < 0.0;
      if (is_new) face.result.wall = wall;
      if (face.result.wall != wall) return "a round face of it has the part on both sides";
      face.off = std::max(face.off, mesh::facet_deviation(surface(face), corners(t)).distance_mm);
      for (const core::Vec3& corner : corners(t))
        face.corners_off = std::max(face.corners_off, std::abs(surface(face).distance(corner)));
    }
    // Cuts of facets leave corners in the middle of these, but no farther off.
    for (const Face& face : faces_)
      if (face.corners_off > tolerance_ + face.off) return "its corners have moved off the surface";
    return {};
  }

  std::string find_edges() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> triangle_at;  // by directed side
    for (std::size_t t = 0; t < part_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        triangle_at[{part_.triangles[t][k], part_.triangles[t][(k + 1) % 3]}] = t;
    for (const auto& [side, t] : triangle_at) {
      const auto other = triangle_at.find({side.second, side.first});
      if (other == triangle_at.end()) return "its mesh is not closed";
      const std::size_t f = face_of_[t], g = face_of_[other->second];
      if (f != g) edges_[{f, g}].sides.push_back({part_.vertices[side.first], part_.vertices[side.second]});
    }
    return {};
  }

  /// The cylinder about the axis of a round face through points of a circle about it.
  std::optional<PartTrim> cylinder_through(const mesh::SupportSurface& about,
                                           const std::vector<core::Vec3>& points) const {
    const auto radius_at = [&](const core::Vec3& p) { return about.axis.cross(p - about.origin).norm(); };
    const double radius = radius_at(points.front());
    for (const core::Vec3& point : points)
      if (std::abs(radius_at(point) - radius) > tolerance_) return std::nullopt;
    return PartTrim{mesh::SupportSurface::cylinder(about.origin, about.axis, radius), {}, false};
  }

  /// A function that changes its sign on `face` where `other` begins.
  std::optional<PartTrim> trim_between(const Face& face, const Face& other, const SharedEdge& edge) const {
    const std::vector<core::Vec3> points = edge.points();
    double least_sine = 1.0;
    for (const core::Vec3& point : points)
      least_sine = std::min(least_sine, normal(face, point).cross(normal(other, point)).norm());
    const bool crosses = least_sine > kTangent;
    if (crosses && !is_round(other)) {
      const WorldPlane& plane = body_.planes[other.result.plane];
      return PartTrim{std::nullopt, plane, false};
    }
    if (crosses && !is_round(face)) return PartTrim{surface(other), {}, false};
    const Arrangement arrangement = arrangement_of(points, tolerance_);
    switch (arrangement.kind) {
      case Arrangement::Kind::line: {
        if (crosses) return PartTrim{surface(other), {}, false};
        const core::Vec3 across = arrangement.direction.cross(normal(face, points.front())).normalized();
        return plane_trim(across, arrangement.through);
      }
      case Arrangement::Kind::plane: {
        // In a flat face, or one at the top of a round one, no plane but a cylinder is across.
        constexpr double kParallel = 1e-6;
        for (const Face* flat : {&face, &other}) {
          if (is_round(*flat) ||
              body_.planes[flat->result.plane].normal.cross(arrangement.direction).norm() > kParallel)
            continue;
          const Face& round = flat == &face ? other : face;
          return is_round(round) ? cylinder_through(surface(round), points) : std::nullopt;
        }
        return plane_trim(arrangement.direction, arrangement.through);
      }
      case Arrangement::Kind::space:
        break;
    }
    if (crosses) return PartTrim{surface(other), {}, false};
    return std::nullopt;
  }

  std::string trim(std::size_t f) {
    Face& face = faces_[f];
    for (auto at = edges_.lower_bound({f, 0}); at != edges_.end() && at->first.first == f; ++at) {
      const std::optional<PartTrim> trim = trim_between(face, faces_[at->first.second], at->second);
      if (!trim) return "a face of it runs into another, smoothly, along a curve that is in no plane";
      double off = 0.0;
      for (const auto& [a, b] : at->second.sides)
        off = std::max(off, std::abs(trim_distance(*trim, onto(face, 0.5 * (a + b)))));
      face.result.trims.push_back(*trim);
      face.outline_off.push_back(off);
      face.off = std::max(face.off, off);
    }
    face.result.bulge_mm = 2.0 * face.off + 1e-9 * size_;
    if (face.result.trims.size() > kMostTrims) return "a face of it borders on more than 1024 others";
    return find_cells(face);
  }

  /// Adds to a face the functions that separate the faces beside it from each other, where these are tangent:
  /// a flat face beside a bend and its straight walls has parts that the walls' own functions do not
  /// distinguish.
  /// @return whether there are any
  bool trim_between_neighbours(std::size_t f) {
    Face& face = faces_[f];
    std::set<std::size_t> beside;
    for (auto at = edges_.lower_bound({f, 0}); at != edges_.end() && at->first.first == f; ++at)
      beside.insert(at->first.second);
    const std::size_t before = face.result.trims.size();
    for (const auto& [pair, edge] : edges_) {
      if (pair.first > pair.second || !beside.contains(pair.first) || !beside.contains(pair.second)) continue;
      const std::optional<PartTrim> between = trim_between(faces_[pair.first], faces_[pair.second], edge);
      if (!between || between->surface) continue;
      face.result.trims.push_back(*between);
      face.outline_off.push_back(0.0);
    }
    face.result.cells.clear();
    return face.result.trims.size() > before;
  }

  /// Sets the cells of a face, by points on its triangles that are clear of its outline.
  std::string find_cells(Face& face) const {
    const std::vector<PartTrim>& trims = face.result.trims;
    std::set<std::vector<bool>> cells;
    std::vector<bool> clearest;
    double most_clear = -1.0;
    const auto add = [&](const core::Vec3& on_facet) {
      const core::Vec3 point = onto(face, on_facet);
      std::vector<bool> signs(trims.size());
      double clear = HUGE_VAL;
      for (std::size_t k = 0; k < trims.size(); ++k) {
        const double distance = std::abs(trim_distance(trims[k], point));
        signs[k] = trim_value(trims[k], point) > 0.0;
        clear = std::min(clear, distance / (1.05 * face.outline_off[k] + 1e-9 * size_));
      }
      if (clear > most_clear) {
        most_clear = clear;
        clearest = signs;
      }
      if (clear > 1.0) cells.insert(std::move(signs));
    };
    const bool many = face.triangles.size() > kManyTriangles;
    for (const std::size_t t : face.triangles) {
      const Corners c = corners(t);
      add((c[0] + c[1] + c[2]) / 3.0);
      if (many) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const core::Vec3 &a = c[k], &b = c[(k + 1) % 3], &d = c[(k + 2) % 3];
        add(0.9 * a + 0.05 * (b + d));
        add(0.6 * a + 0.2 * (b + d));
        add(0.48 * (a + b) + 0.04 * d);
        add(0.3 * a + 0.68 * b + 0.02 * d);
      }
    }
    if (cells.empty()) cells.insert(clearest);
    if (cells.size() == 1) {
      for (std::size_t k = 0; k < trims.size(); ++k) face.result.trims[k].above = (*cells.begin())[k];
      return {};
    }
    if (trims.size() > kMostCellTrims) return "a face of it has an outline of too many pieces";
    for (const std::vector<bool>& cell : cells) {
      std::uint64_t signs = 0;
      for (std::size_t k = 0; k < cell.size(); ++k)
        if (cell[k]) signs |= std::uint64_t{1} << k;
      face.result.cells.push_back(signs);
    }
    std::sort(face.result.cells.begin(), face.result.cells.end());
    return {};
  }

  bool is_within(const PartFace& face, const core::Vec3& point) const {
    std::uint64_t signs = 0;
    for (std::size_t k = 0; k < face.trims.size(); ++k) {
      const bool above = trim_value(face.trims[k], point) > 0.0;
      if (face.cells.empty() && above != face.trims[k].above) return false;
      if (above && k < kMostCellTrims) signs |= std::uint64_t{1} << k;
    }
    return face.cells.empty() || std::binary_search(face.cells.begin(), face.cells.end(), signs);
  }

  /// Compares points of a face's surface, within the box around the face, with its triangles.
  std::string check_beyond(std::size_t f) const {
    const Face& face = faces_[f];
    Eigen::AlignedBox3d box;
    for (const core::Vec3& corner : face.result.corners) box.extend(corner);
    box = Eigen::AlignedBox3d(box.min() - core::Vec3::Constant(face.result.bulge_mm),
                              box.max() + core::Vec3::Constant(face.result.bulge_mm));
    const double near = 3.0 * face.off + 1e-6 * size_;
    const auto on_triangles = [&](const core::Vec3& point) {
      return std::any_of(face.triangles.begin(), face.triangles.end(), [&](std::size_t t) {
        const Corners c = corners(t);
        return mesh::distance_to_triangle(point, c[0], c[1], c[2]) <= near;
      });
    };
    const int points = face.triangles.size() > kManyTriangles ? kBeyond / 8 : kBeyond;
    for (int i = 0; i < points; ++i) {
      const core::Vec3 start = box.min() + box.sizes().cwiseProduct(even_point(i));
      const core::Vec3 point = onto(face, start);
      if (!point.allFinite() || !box.contains(point)) continue;
      if (is_round(face) && !(std::abs(surface(face).distance(point)) <= 1e-9 * size_)) continue;
      if (is_within(face.result, point) && !on_triangles(point))
        return "the outline of a face of it cannot be described by the surfaces beside it";
    }
    return {};
  }

  /// Rays across the part lead into it and out of it in turn.
  std::string check_rays() const {
    const ExactBodies alone = part_alone(body_);
    for (int i = 0; i < kRays; ++i) {
      const core::Vec3 at = even_point(2 * i), to = even_point(2 * i + 1);
      const core::Vec3 low = alone.bodies.front().low, size = alone.bodies.front().high - low;
      core::Vec3 origin = low + size.cwiseProduct(at);
      const core::Vec3 direction = (low + size.cwiseProduct(to) - origin).normalized();
      origin -= 2.0 * size.norm() * direction;
      if (!alone.alternates(alone.bodies.front(), origin, direction))
        return "its exact faces do not close around it";
    }
    return {};
  }

  const contact::PlacedPart& part_;
  double tolerance_;
  PartBody& body_;
  double size_ = 0.0;
  std::vector<Face> faces_;
  std::vector<std::size_t> face_of_;  ///< of each triangle
  std::map<std::pair<std::size_t, std::size_t>, SharedEdge> edges_;
};

}  // namespace

std::string find_trimmed_faces(const contact::PlacedPart& part, double tolerance_mm, PartBody& body) {
  std::string reason = TrimmedFaceFinder(part, tolerance_mm, body).find();
  if (!reason.empty()) body.faces.clear();
  return reason;
}

}  // namespace scintray::scene
