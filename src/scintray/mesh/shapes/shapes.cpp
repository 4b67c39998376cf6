#include "scintray/mesh/shapes/shapes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/profile.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {
namespace {

/// A convex polygon at a height, counter-clockwise seen from +z. Neighbouring corners may coincide.
struct LoftRing {
  double z = 0.0;
  std::vector<Eigen::Vector2d> corners;
};

/// Adds vertices and triangles, each vertex of a ring once.
class Lofter {
 public:
  std::vector<std::uint32_t> add_ring(const LoftRing& ring) {
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < ring.corners.size(); ++i) {
      const bool same_as_last = i > 0 && ring.corners[i] == ring.corners[i - 1];
      const bool same_as_first = i + 1 == ring.corners.size() && i > 0 && ring.corners[i] == ring.corners[0];
      if (same_as_last) {
        ids.push_back(ids.back());
      } else if (same_as_first) {
        ids.push_back(ids.front());
      } else {
        ids.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        mesh.vertices.emplace_back(ring.corners[i].x(), ring.corners[i].y(), ring.z);
      }
    }
    return ids;
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, const std::string& group) {
    if (a == b || b == c || c == a) return;
    mesh.triangles.push_back({a, b, c});
    mesh.group.push_back(group_id(group));
  }

  void add_cap(const std::vector<std::uint32_t>& ring, bool top, const std::string& group) {
    if (flattest(ring) < kFlatCap * extent()) {
      core::Vec3 middle = core::Vec3::Zero();
      for (const std::uint32_t corner : ring)
        middle += mesh.vertices[corner] / static_cast<double>(ring.size());
      const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(middle);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t next = ring[(i + 1) % ring.size()];
        add_triangle(centre, top ? ring[i] : next, top ? next : ring[i], group);
      }
      return;
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      add_triangle(ring[0], top ? ring[i] : ring[i + 1], top ? ring[i + 1] : ring[i], group);
  }

  TriMesh mesh;

 private:
  /// Largest side of the box around the vertices, mm.
  double extent() const {
    Eigen::AlignedBox3d bounds;
    for (const core::Vec3& vertex : mesh.vertices) bounds.extend(vertex);
    return bounds.diagonal().maxCoeff();
  }

  /// Least height of a triangle of three neighbouring corners, mm; infinite for up to a few corners, and
  /// where corners coincide or lie on a line, as in a slit or a box with corners to spare.
  double flattest(const std::vector<std::uint32_t>& ring) const {
    constexpr std::size_t kFewCorners = 16;
    double least = std::numeric_limits<double>::infinity();
    if (ring.size() <= kFewCorners) return least;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const core::Vec3 &a = mesh.vertices[ring[i]], &b = mesh.vertices[ring[(i + 1) % ring.size()]],
                       &c = mesh.vertices[ring[(i + 2) % ring.size()]];
      const double base = (c - a).norm();
      const double height = base > 0.0 ? (b - a).cross(c - a).norm() / base : 0.0;
      if (!(height > 0.0)) return std::numeric_limits<double>::infinity();
      least = std::min(least, height);
    }
    return least;
  }

  std::uint32_t group_id(const std::string& name) {
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), name);
    if (found == mesh.groups.end()) {
      mesh.groups.push_back(name);
      return static_cast<std::uint32_t>(mesh.groups.size() - 1);
    }
    return static_cast<std::uint32_t>(found - mesh.groups.begin());
  }
};

/// The closed body between rings of rising z that have the same number of corners, corner i joined to
/// corner i. Sides that shrink to a line or a point are left out.
///
/// @param side_groups  group of the side between corners i and i + 1, by layer (rings less one), then i
/// Both ends are fans without a middle vertex, in the groups "-z" and "+z".
TriMesh make_loft(const std::vector<LoftRing>& rings,
                  const std::vector<std::vector<std::string>>& side_groups) {
  Lofter lofter;
  std::vector<std::vector<std::uint32_t>> ids;
  for (const LoftRing& ring : rings) ids.push_back(lofter.add_ring(ring));
  for (std::size_t layer = 0; layer + 1 < ids.size(); ++layer) {
    const auto &low = ids[layer], &high = ids[layer + 1];
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t next = (i + 1) % low.size();
      const std::string& group = side_groups[layer][i];
      lofter.add_triangle(low[i], low[next], high[next], group);
      lofter.add_triangle(low[i], high[next], high[i], group);
    }
  }
  lofter.add_cap(ids.front(), false, "-z");
  lofter.add_cap(ids.back(), true, "+z");
  return std::move(lofter.mesh);
}

/// Corners of a regular polygon, first on +x.
std::vector<Eigen::Vector2d> regular_polygon(int corners, double circumradius) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = core::kTwoPi * i / corners;
    points.emplace_back(circumradius * std::cos(angle), circumradius * std::sin(angle));
  }
  return points;
}

/// Corners of a rectangle: (low x, low y), then counter-clockwise. Its sides are "-y", "+x", "+y", "-x".
std::vector<Eigen::Vector2d> rectangle_corners(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

using Vec2 = Eigen::Vector2d;

const std::vector<std::string> kRectangleSides{"-y", "+x", "+y", "-x"};

void require(bool ok, const std::string& what, const std::string& hint) {
  if (!ok) throw core::InputError(core::Problem{{}, what, hint});
}

bool is_length(double x) { return std::isfinite(x) && x > 0.0; }

std::vector<std::string> numbered_sides(int sides) {
  std::vector<std::string> names;
  for (int i = 0; i < sides; ++i) names.push_back("side" + std::to_string(i));
  return names;
}

TriMesh straight_prism(const std::vector<Vec2>& outline, double z0, double z1,
                       const std::vector<std::string>& sides) {
  return make_loft({{z0, outline}, {z1, outline}}, {sides});
}

/// Points of a chamfered outline for each corner of the sharp one: on the end face, and on the two sides
/// that share the corner.
struct ChamferedOutline {
  std::vector<Vec2> inset;  ///< every point twice, to pair with `sides`
  std::vector<Vec2> sides;  ///< two per corner: end of the side before it, start of the side after it
};

ChamferedOutline chamfered(const std::vector<Vec2>& outline, double chamfer) {
  ChamferedOutline result;
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = (outline[i] - outline[(i + n - 1) % n]).normalized();
    const Vec2 after = (outline[(i + 1) % n] - outline[i]).normalized();
    const Vec2 inward_before(-before.y(), before.x()), inward_after(-after.y(), after.x());
    // The point at distance `chamfer` from both sides, and its feet on them.
    const Vec2 bisector = inward_before + inward_after;
    const Vec2 inset = outline[i] + bisector * (2.0 * chamfer / bisector.squaredNorm());
    result.inset.insert(result.inset.end(), {inset, inset});
    result.sides.push_back(inset - chamfer * inward_before);
    result.sides.push_back(inset - chamfer * inward_after);
  }
  return result;
}

TriMesh chamfered_prism(const std::vector<Vec2>& outline, double z0, double z1, double chamfer,
                        const std::vector<std::string>& sides) {
  const ChamferedOutline cut = chamfered(outline, chamfer);
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 whole = outline[(i + 1) % n] - outline[i];
    const Vec2 left = cut.sides[(2 * i + 2) % (2 * n)] - cut.sides[2 * i + 1];
    require(is_length(chamfer) && whole.dot(left) > 0.0 && z1 - z0 > 2.0 * chamfer,
            "a chamfer that is not positive or leaves nothing of a face",
            "give a width below half of the shortest edge");
  }
  const std::vector<std::string> bevels(2 * n, "chamfer");
  std::vector<std::string> middle;
  for (const std::string& side : sides) middle.insert(middle.end(), {"chamfer", side});
  return make_loft({{z0, cut.inset}, {z0 + chamfer, cut.sides}, {z1 - chamfer, cut.sides}, {z1, cut.inset}},
                   {bevels, middle, bevels});
}

/// A point of the concentrator's profile at its parameter phi, from 2 theta (full entrance) to theta +
/// 90 deg (exit).
struct ProfilePoint {
  double radius, z;
};
ProfilePoint winston_profile(double exit_radius, double theta, double phi) {
  const double scale = 2.0 * exit_radius * (1.0 + std::sin(theta)) / (1.0 - std::cos(phi));
  return {scale * std::sin(phi - theta) - exit_radius, scale * std::cos(phi - theta)};
}

/// Rate at which the squared radius of the profile grows along z.
double winston_rate(double exit_radius, double theta, double phi) {
  const double away = 1.0 - std::cos(phi), along = phi - theta;
  const double across = std::cos(along) * away - std::sin(along) * std::sin(phi);
  const double down = -std::sin(along) * away - std::cos(along) * std::sin(phi);
  return 2.0 * winston_profile(exit_radius, theta, phi).radius * across / down;
}

double winston_parameter(double exit_radius, double theta, double z) {
  double entrance = 2.0 * theta, exit = theta + 0.5 * core::kPi;  // z falls as phi rises
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (entrance + exit);
    (winston_profile(exit_radius, theta, middle).z > z ? entrance : exit) = middle;
  }
  return 0.5 * (entrance + exit);
}

/// @param entrance  parameter of the profile there
TriMesh round_winston(const WinstonShape& shape, double length, double entrance) {
  const double theta = shape.acceptance_rad, exit = theta + 0.5 * core::kPi;
  Profile walls;
  SmoothPoint before;
  for (int i = 0; i <= shape.rings; ++i) {
    const double phi = exit + (entrance - exit) * i / shape.rings;
    const ProfilePoint point = winston_profile(shape.exit_radius, theta, phi);
    const double z = i == 0 ? 0.0 : i == shape.rings ? length : point.z;
    const SmoothPoint next{z, point.radius * point.radius, winston_rate(shape.exit_radius, theta, phi)};
    if (i > 0) add_smooth(walls, before, next, "side");
    before = next;
  }
  std::vector<LoftRing> rings;
  for (const Vec2& corner : walls.corners)
    rings.push_back({corner.y(), regular_polygon(shape.segments, corner.x())});
  rings.push_back({before.z, regular_polygon(shape.segments, std::sqrt(before.radius2))});
  const std::vector<std::string> side(static_cast<std::size_t>(shape.segments), "side");
  TriMesh mesh = make_loft(rings, std::vector(walls.sides.size(), side));
  const auto strip = static_cast<std::size_t>(2 * shape.segments);
  for (std::size_t i = 0; i < walls.sides.size(); ++i)
    mesh.set_support(*walls.sides[i].surface, i * strip, (i + 1) * strip);
  return mesh;
}

}  // namespace

TriMesh make_prism(int sides, double circumradius, double height, double chamfer) {
  require(sides >= 3, "a prism of " + std::to_string(sides) + " sides", "give at least 3 sides");
  require(is_length(circumradius) && is_length(height), "a prism needs a positive radius and height", "");
  const std::vector<Vec2> outline = regular_polygon(sides, circumradius);
  const std::vector<std::string> names = numbered_sides(sides);
  return chamfer == 0.0 ? straight_prism(outline, 0.0, height, names)
                        : chamfered_prism(outline, 0.0, height, chamfer, names);
}

TriMesh make_chamfered_box(const core::Vec3& low, const core::Vec3& high, double chamfer) {
  require(low.allFinite() && high.allFinite() && ((high - low).array() > 0.0).all(),
          "a box needs three positive finite sides",
          "the first corner must be below the second along x, y and z");
  return chamfered_prism(rectangle_corners(low.head<2>(), high.head<2>()), low.z(), high.z(), chamfer,
                         kRectangleSides);
}

TriMesh make_tapered(const Rectangle& bottom, const Rectangle& top, double height) {
  require(is_length(height), "a taper needs a positive height", "");
  std::vector<LoftRing> rings;
  for (const Rectangle* end : {&bottom, &top}) {
    const Vec2 half(0.5 * end->size[0], 0.5 * end->size[1]), centre(end->centre[0], end->centre[1]);
    require(is_length(half.x()) && is_length(half.y()) && centre.allFinite(),
            "the ends of a taper need positive sizes", "");
    rings.push_back({end == &bottom ? 0.0 : height, rectangle_corners(centre - half, centre + half)});
  }
  return make_loft(rings, {kRectangleSides});
}

double winston_length(double exit_radius, double acceptance_rad) {
  return exit_radius * (1.0 + 1.0 / std::sin(acceptance_rad)) / std::tan(acceptance_rad);
}

double winston_radius(double exit_radius, double acceptance_rad, double z) {
  const double phi = winston_parameter(exit_radius, acceptance_rad, z);
  return winston_profile(exit_radius, acceptance_rad, phi).radius;
}

TriMesh make_winston(const WinstonShape& shape) {
  const double theta = shape.acceptance_rad;
  require(is_length(shape.exit_radius), "a Winston cone needs a positive exit radius", "");
  require(theta > 0.0 && theta < 0.5 * core::kPi, "an acceptance angle outside 0 to 90 deg",
          "give the largest angle to the axis that is to reach the exit");
  require(shape.segments >= 3 && shape.rings >= 1, "a Winston cone of too few segments or rings",
          "give 3 segments and 1 ring at least");
  const double full = winston_length(shape.exit_radius, theta);
  const double length = shape.length == 0.0 ? full : shape.length;
  require(is_length(length) && length <= full * (1.0 + 1e-12),
          "a Winston cone longer than " + std::to_string(full) + " mm, where its walls become parallel",
          "give that length or less");
  const double entrance =
      shape.length == 0.0 ? 2.0 * theta : winston_parameter(shape.exit_radius, theta, length);
  if (!(shape.trough_width > 0.0)) return round_winston(shape, length, entrance);
  std::vector<LoftRing> rings;
  for (int i = 0; i <= shape.rings; ++i) {
    const double exit = theta + 0.5 * core::kPi;
    const ProfilePoint point =
        winston_profile(shape.exit_radius, theta, exit + (entrance - exit) * i / shape.rings);
    // The ends are set to their known values, free of rounding.
    const double z = i == 0 ? 0.0 : i == shape.rings ? length : point.z;
    const Vec2 half(point.radius, 0.5 * shape.trough_width);
    rings.push_back({z, rectangle_corners(-half, half)});
  }
  return make_loft(rings, std::vector(static_cast<std::size_t>(shape.rings), kRectangleSides));
}

}  // namespace scintray::mesh
