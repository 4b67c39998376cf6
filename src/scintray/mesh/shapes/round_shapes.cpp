#include <algorithm>
#include <cmath>
#include <string>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {

namespace {

/// Length, relative to a body, that counts as zero.
constexpr double kNothing = 1e-9;

std::uint32_t new_vertex(TriMesh& mesh, const core::Vec3& point) {
  mesh.vertices.push_back(point);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void new_triangle(TriMesh& mesh, const std::array<std::uint32_t, 3>& corners, std::uint32_t group,
                  std::uint32_t support) {
  mesh.triangles.push_back(corners);
  mesh.group.push_back(group);
  mesh.support.push_back(support);
}

/// Maker of a box with rounded edges and corners.
class RoundedBox {
 public:
  RoundedBox(const core::Vec3& low, const core::Vec3& high, double radius, int segments)
      : low_(low + core::Vec3::Constant(radius)),
        high_(high - core::Vec3::Constant(radius)),
        radius_(radius),
        steps_(std::max(1, (segments + 3) / 4)) {}

  TriMesh make() {
    mesh_.groups = {"-x", "+x", "-y", "+y", "-z", "+z", "rounding"};
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) add_face(axis, side);
    for (int along = 0; along < 3; ++along)
      for (const double one : {-1.0, 1.0})
        for (const double other : {-1.0, 1.0}) add_edge(along, one, other);
    for (unsigned corner = 0; corner < 8; ++corner)
      add_corner({corner & 1u ? 1.0 : -1.0, corner & 2u ? 1.0 : -1.0, corner & 4u ? 1.0 : -1.0});
    weld_vertices(mesh_, kNothing * radius_);
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kRoundingGroup = 6;

  /// Centre of the sphere of a corner.
  core::Vec3 centre(const core::Vec3& sides) const {
    core::Vec3 result;
    for (int axis = 0; axis < 3; ++axis) result[axis] = sides[axis] > 0.0 ? high_[axis] : low_[axis];
    return result;
  }
  /// A triangle, outwards: its corners in either order.
  void add(std::array<core::Vec3, 3> corners, const core::Vec3& outwards, std::uint32_t group,
           std::uint32_t support) {
    if ((corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(outwards) < 0.0)
      std::swap(corners[1], corners[2]);
    new_triangle(
        mesh_, {new_vertex(mesh_, corners[0]), new_vertex(mesh_, corners[1]), new_vertex(mesh_, corners[2])},
        group, support);
  }
  void add_quad(const std::array<core::Vec3, 4>& c, const core::Vec3& outwards, std::uint32_t group,
                std::uint32_t support) {
    add({c[0], c[1], c[2]}, outwards, group, support);
    add({c[0], c[2], c[3]}, outwards, group, support);
  }

  void add_face(int axis, double side) {
    core::Vec3 outwards = core::Vec3::Zero();
    outwards[axis] = side;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<core::Vec3, 4> corners;
    constexpr double kSides[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t k = 0; k < 4; ++k) {
      core::Vec3 sides = outwards;
      sides[u] = kSides[k][0];
      sides[v] = kSides[k][1];
      corners[k] = centre(sides) + radius_ * outwards;
    }
    add_quad(corners, outwards, static_cast<std::uint32_t>(2 * axis + (side > 0.0)), kNoSupport);
  }

  /// Direction at a step of the quarter circle from one axis to another.
  core::Vec3 on_quarter(const core::Vec3& from, const core::Vec3& to, int step) const {
    if (step == 0) return from;
    if (step == steps_) return to;
    const double angle = 0.5 * core::kPi * step / steps_;
    return std::cos(angle) * from + std::sin(angle) * to;
  }

  void add_edge(int along, double one, double other) {
    const int u = (along + 1) % 3, v = (along + 2) % 3;
    core::Vec3 from = core::Vec3::Zero(), to = core::Vec3::Zero(), axis = core::Vec3::Zero();
    from[u] = one;
    to[v] = other;
    axis[along] = 1.0;
    const core::Vec3 low = centre(from + to - axis), high = centre(from + to + axis);
    const std::uint32_t support = mesh_.support_index(SupportSurface::cylinder(low, axis, radius_));
    for (int step = 0; step < steps_; ++step) {
      const core::Vec3 a = radius_ * on_quarter(from, to, step), b = radius_ * on_quarter(from, to, step + 1);
      add_quad({low + a, low + b, high + b, high + a}, from + to, kRoundingGroup, support);
    }
  }

  /// Rows of an eighth of a sphere, from its z axis down; row n has n + 1 points.
  void add_corner(const core::Vec3& sides) {
    const core::Vec3 middle = centre(sides);
    const core::Vec3 x(sides.x(), 0, 0), y(0, sides.y(), 0), z(0, 0, sides.z());
    const std::uint32_t support = mesh_.support_index(SupportSurface::sphere(middle, radius_));
    const auto point = [&](int row, int column) {
      if (row == steps_) return core::Vec3(middle + radius_ * on_quarter(x, y, column));
      if (column == 0) return core::Vec3(middle + radius_ * on_quarter(z, x, row));
      if (column == row) return core::Vec3(middle + radius_ * on_quarter(z, y, row));
      const double down = 0.5 * core::kPi * row / steps_, around = 0.5 * core::kPi * column / row;
      return core::Vec3(middle + radius_ * (std::cos(down) * z +
                                            std::sin(down) * (std::cos(around) * x + std::sin(around) * y)));
    };
    for (int row = 1; row <= steps_; ++row)
      for (int column = 0; column < row; ++column) {
        add({point(row - 1, column), point(row, column), point(row, column + 1)}, sides, kRoundingGroup,
            support);
        if (column + 1 < row)
          add({point(row - 1, column), point(row, column + 1), point(row - 1, column + 1)}, sides,
              kRoundingGroup, support);
      }
  }

  core::Vec3 low_, high_;  ///< of the centres of the corners' spheres
  double radius_;
  int steps_;  ///< of a quarter circle
  TriMesh mesh_;
};

/// A place of a rod: where its middle is, and the directions of its section.
struct Section {
  core::Vec3 middle, u, v;
};

/// Maker of a rod along a path.
class FibreMaker {
 public:
  explicit FibreMaker(const FibreShape& shape) : shape_(shape), round_(shape.radius > 0.0) {}

  TriMesh make() {
    check();
    mesh_.groups = round_ ? std::vector<std::string>{"side", "start", "end"}
                          : std::vector<std::string>{"side0", "side1", "side2", "side3", "start", "end"};
    const auto end_group = static_cast<std::uint32_t>(mesh_.groups.size() - 2);
    direction_ = (shape_.path[1] - shape_.path[0]).normalized();
    const core::Vec3 u = round_ ? any_across(direction_) : direction_.cross(plane_normal()).normalized();
    section_ = {shape_.path.front(), u, direction_.cross(u)};
    ring_ = add_ring();
    add_end(end_group, true);
    for (std::size_t i = 1; i < shape_.path.size(); ++i) {
      const bool last = i + 1 == shape_.path.size();
      go_straight(shape_.path[i] - (last ? 0.0 : tangent_length(i)) * direction_);
      if (!last) go_round(i);
    }
    add_end(end_group + 1, false);
    if (mesh_.supports.empty()) mesh_.support.clear();
    return std::move(mesh_);
  }

 private:
  static core::Vec3 any_across(const core::Vec3& direction) {
    int least = 0;
    direction.cwiseAbs().minCoeff(&least);
    return direction.cross(core::Vec3::Unit(least)).normalized();
  }
  core::Vec3 leg(std::size_t corner) const {
    return (shape_.path[corner + 1] - shape_.path[corner]).normalized();
  }
  /// Angle by which the path turns at a corner.
  double turn(std::size_t corner) const {
    const core::Vec3 a = leg(corner - 1), b = leg(corner);
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }
  double tangent_length(std::size_t corner) const {
    return shape_.bend_radius * std::tan(0.5 * turn(corner));
  }
  bool is_straight(std::size_t corner) const { return turn(corner) < kNothing; }

  /// Normal of the plane of a square rod's path; of a straight one any.
  core::Vec3 plane_normal() const {
    for (std::size_t i = 1; i + 1 < shape_.path.size(); ++i)
      if (!is_straight(i)) return leg(i - 1).cross(leg(i)).normalized();
    return any_across(leg(0));
  }

  void check() const {
    const std::vector<core::Vec3>& path = shape_.path;
    if (path.size() < 2) reject_shape("a fibre along fewer than 2 points", "give path 2 points or more");
    if (!(round_ ? shape_.radius > 0.0 : shape_.side > 0.0))
      reject_shape("a fibre without a positive radius or side", "");
    if (shape_.segments < 3) reject_shape("a fibre of fewer than 3 segments", "give at least 3");
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      if (!((path[i + 1] - path[i]).norm() > 0.0))
        reject_shape(
            "points " + std::to_string(i) + " and " + std::to_string(i + 1) + " of a fibre's path coincide",
            "leave one of them out");
    const double half = round_ ? shape_.radius : 0.5 * shape_.side;
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
      if (is_straight(i)) continue;
      const std::string at = " at point " + std::to_string(i) + " of a fibre's path";
      if (!(shape_.bend_radius > half))
        reject_shape("a bend" + at + " that is tighter than the fibre is thick",
                     "give bend_radius a length above half of the fibre's thickness");
      constexpr double kTurnsBack = core::kPi * (1.0 - 1e-6);
      if (turn(i) > kTurnsBack) reject_shape("the path turns back" + at, "give it a point beside");
    }
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      double needed = 0.0;
      for (const std::size_t corner : {i, i + 1})
        if (corner > 0 && corner + 1 < path.size() && !is_straight(corner)) needed += tangent_length(corner);
      const double length = (path[i + 1] - path[i]).norm();
      if (needed > length * (1.0 + kNothing))
        reject_shape("arcs of bend_radius take " + std::to_string(needed) + " mm of the " +
                         std::to_string(length) + " mm between points " + std::to_string(i) + " and " +
                         std::to_string(i + 1) + " of a fibre's path",
                     "give a smaller bend_radius, or points farther apart");
    }
    if (round_) return;
    const core::Vec3 normal = plane_normal();
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      if (std::abs(leg(i).dot(normal)) > kNothing)
        reject_shape("the path of a square fibre that is in no plane", "give a round one");
  }

  std::vector<core::Vec3> offsets() const {
    std::vector<core::Vec3> result;
    const int count = round_ ? shape_.segments : 4;
    for (int i = 0; i < count; ++i) {
      // Side 0 of a square is on the side of u.
      const double angle = core::kTwoPi * i / count - (round_ ? 0.0 : 0.25 * core::kPi);
      const double far = round_ ? shape_.radius : std::sqrt(0.5) * shape_.side;
      result.push_back(far * (std::cos(angle) * section_.u + std::sin(angle) * section_.v));
    }
    return result;
  }
  std::vector<std::uint32_t> add_ring() {
    std::vector<std::uint32_t> ring;
    for (const core::Vec3& offset : offsets()) ring.push_back(new_vertex(mesh_, section_.middle + offset));
    return ring;
  }
  void add_end(std::uint32_t group, bool start) {
    const std::uint32_t middle = new_vertex(mesh_, section_.middle);
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const std::uint32_t a = ring_[i], b = ring_[(i + 1) % ring_.size()];
      new_triangle(mesh_, {middle, start ? b : a, start ? a : b}, group, kNoSupport);
    }
  }
  /// Walls from the last ring to a new one.
  void add_walls(const std::vector<std::uint32_t>& supports) {
    const std::vector<std::uint32_t> next = add_ring();
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const std::size_t j = (i + 1) % ring_.size();
      const std::uint32_t group = round_ ? 0 : static_cast<std::uint32_t>(i);
      const std::uint32_t support = supports[round_ ? 0 : i];
      new_triangle(mesh_, {ring_[i], ring_[j], next[j]}, group, support);
      new_triangle(mesh_, {ring_[i], next[j], next[i]}, group, support);
    }
    ring_ = next;
  }

  void go_straight(const core::Vec3& to) {
    if (!((to - section_.middle).norm() > kNothing * (round_ ? shape_.radius : shape_.side))) return;
    std::vector<std::uint32_t> supports(4, kNoSupport);
    if (round_)
      supports[0] = mesh_.support_index(SupportSurface::cylinder(section_.middle, direction_, shape_.radius));
    section_.middle = to;
    add_walls(supports);
  }

  void go_round(std::size_t corner) {
    const double angle = turn(corner);
    if (angle < kNothing) return;
    const core::Vec3 axis = leg(corner - 1).cross(leg(corner)).normalized();
    const core::Vec3 centre = section_.middle + shape_.bend_radius * axis.cross(direction_);
    std::vector<std::uint32_t> supports(4, kNoSupport);
    if (round_) {
      supports[0] =
          mesh_.support_index(SupportSurface::torus(centre, axis, shape_.bend_radius, shape_.radius));
    } else {
      for (const std::size_t side : {0u, 2u}) {
        const double away = (side == 0 ? 0.5 : -0.5) * shape_.side;
        const double radius = (section_.middle + away * section_.u - centre).norm();
        supports[side] = mesh_.support_index(SupportSurface::cylinder(centre, axis, radius));
      }
    }
    const int steps =
        std::max(1, static_cast<int>(std::ceil(angle / core::kTwoPi * shape_.segments - kNothing)));
    const Section start = section_;
    const core::Vec3 from = direction_;
    for (int step = 1; step <= steps; ++step) {
      const Eigen::Matrix3d turned = Eigen::AngleAxisd(angle * step / steps, axis).toRotationMatrix();
      section_ = {centre + turned * (start.middle - centre), turned * start.u, turned * start.v};
      direction_ = turned * from;
      add_walls(supports);
    }
    direction_ = leg(corner);
  }

  const FibreShape& shape_;
  const bool round_;
  TriMesh mesh_;
  Section section_;
  core::Vec3 direction_;
  std::vector<std::uint32_t> ring_;
};

}  // namespace

TriMesh make_spheroid(double radius, double half_height, int subdivisions) {
  if (!(radius > 0.0) || !(half_height > 0.0))
    reject_shape("a spheroid needs a positive radius and half_height", "");
  TriMesh mesh = make_sphere(1.0, subdivisions);
  mesh.groups = {"spheroid"};
  for (core::Vec3& vertex : mesh.vertices)
    vertex = core::Vec3(radius * vertex.x(), radius * vertex.y(), half_height * vertex.z());
  mesh.supports = {SupportSurface::spheroid(core::Vec3::Zero(), core::Vec3::UnitZ(), radius, half_height)};
  return mesh;
}

TriMesh make_rounded_box(const core::Vec3& low, const core::Vec3& high, double radius, int segments) {
  if (!low.allFinite() || !high.allFinite() || !((high - low).array() > 0.0).all())
    reject_shape("a box needs three positive finite sides",
                 "the first corner must be below the second along x, y and z");
  if (!(radius > 0.0) || !(2.0 * radius < (high - low).minCoeff()))
    reject_shape("a rounding that is not positive, or leaves nothing of a face",
                 "give a radius above 0 and below half of the shortest edge");
  if (segments < 3)
    reject_shape("a rounding of " + std::to_string(segments) + " segments", "give at least 3 segments");
  return RoundedBox(low, high, radius, segments).make();
}

TriMesh make_fibre(const FibreShape& shape) { return FibreMaker(shape).make(); }

}  // namespace scintray::mesh
