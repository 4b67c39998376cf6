#include <algorithm>
#include <cmath>
#include <string>

#include "scintray/mesh/shapes/profile.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/shapes/shapes.hpp"

namespace scintray::mesh {

namespace {

/// Length, relative to the body, that counts as zero.
constexpr double kOnProfile = 1e-9;

void check_sections(int segments, const char* what) {
  if (segments < 3)
    reject_shape(std::string(what) + " of " + std::to_string(segments) + " segments",
                 "give at least 3 segments");
}

/// A face of a lens.
struct LensFace {
  double vertex_z = 0.0;
  double up = 1.0;  ///< -1 for the upper face, whose sagitta leads down
  double radius = 0.0, conic = 0.0;
  const std::vector<double>& aspheric;
  const char* group;

  bool is_flat() const { return radius == 0.0; }
  double depth(double height) const { return sagitta(radius, height, conic, aspheric); }
  double z(double height) const { return vertex_z + up * depth(height); }
  /// Rate at which the squared radius grows along z.
  double rate(double height) const {
    const double curvature = 1.0 / radius, u = height * height;
    double slope = 0.5 * curvature / std::sqrt(1.0 - (1.0 + conic) * curvature * curvature * u);
    double power = 1.0;
    for (std::size_t i = 0; i < aspheric.size(); ++i) {
      power *= u;
      slope += static_cast<double>(i + 2) * aspheric[i] * power;
    }
    return up / slope;
  }
  /// The one quadric of a face without aspheric terms.
  SupportSurface surface() const {
    const core::Vec3 vertex(0.0, 0.0, vertex_z);
    if (conic == 0.0)
      return SupportSurface::sphere(vertex + core::Vec3(0.0, 0.0, up * radius), std::abs(radius));
    const double inwards = radius > 0.0 ? up : -up;
    return SupportSurface::quadric(vertex, {0.0, 0.0, inwards}, 1.0 + conic, std::abs(radius), 0.0);
  }
};

void check_face(const LensFace& face, double half) {
  if (face.is_flat()) {
    if (face.conic != 0.0 || !face.aspheric.empty())
      reject_shape("an aspheric lens face without a radius of curvature", "give the radius at its vertex");
    return;
  }
  if ((1.0 + face.conic) * half * half > face.radius * face.radius * (1.0 + kOnProfile))
    reject_shape(face.conic == 0.0 ? "a lens face with a radius of curvature below half its diameter"
                                   : "a conic lens face that ends before the edge of the lens",
                 "give a radius of half the diameter or more, or leave it out for a flat face");
  constexpr int kPlaces = 200;
  for (int i = 0; i < kPlaces; ++i)
    if (!face.aspheric.empty() && !(face.rate(half * i / kPlaces) * face.radius * face.up > 0.0))
      reject_shape("an aspheric lens face that turns back towards its vertex",
                   "give terms with which its depth grows all the way to the edge");
}

/// Heights of the corners of a lens face from the axis outwards.
std::vector<double> face_heights(const LensFace& face, const LensShape& shape) {
  const double half = 0.5 * shape.diameter;
  if (face.is_flat()) return {0.0, half};
  const double angle = std::asin(std::min(1.0, half / std::abs(face.radius)));
  const int least = face.aspheric.empty() ? 2 : 12;
  const int pieces = std::max(least, static_cast<int>(std::ceil(angle / core::kTwoPi * shape.segments)));
  std::vector<double> heights;
  for (int i = 0; i <= pieces; ++i)
    heights.push_back(i == pieces ? half : std::abs(face.radius) * std::sin(angle * i / pieces));
  return heights;
}

/// The face's walls, from the axis outwards, with its last corner; backwards for the upper face.
Profile face_profile(const LensFace& face, const LensShape& shape) {
  Profile profile;
  const std::vector<double> heights = face_heights(face, shape);
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const double from = heights[i], to = heights[i + 1];
    if (face.aspheric.empty()) {
      profile.add({from, face.z(from)}, face.group,
                  face.is_flat() ? std::nullopt : std::optional(face.surface()));
    } else {
      add_smooth(profile, {face.z(from), from * from, face.rate(from)}, {face.z(to), to * to, face.rate(to)},
                 face.group);
    }
  }
  profile.add({heights.back(), face.z(heights.back())}, face.group);
  return profile;
}

/// Adds the smooth walls of a range of corners of a profile, with rates from the parabolas through three
/// neighbours each. @return the number of its last corner, which is not added
std::size_t add_smooth_range(Profile& walls, const std::vector<std::array<double, 2>>& profile,
                             const std::array<std::size_t, 2>& range) {
  const auto [first, last] = range;
  if (last <= first + 1 || last >= profile.size())
    reject_shape(
        "a smooth range of a profile from corner " + std::to_string(first) + " to " + std::to_string(last),
        "give the numbers of its first and last corner, counted from 0, with one between them");
  std::vector<SmoothPoint> points;
  for (std::size_t i = first; i <= last; ++i)
    points.push_back({profile[i][1], profile[i][0] * profile[i][0], 0.0});
  const bool up = points.back().z > points.front().z;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!((points[i].z > points[i - 1].z) == up && points[i].z != points[i - 1].z))
      reject_shape("a smooth range of a profile that does not rise, or fall, all along the axis",
                   "cut it where it turns back: each range has its z in order");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t middle = std::clamp<std::size_t>(i, 1, points.size() - 2);
    const SmoothPoint &a = points[middle - 1], &b = points[middle], &c = points[middle + 1];
    const double first_slope = (b.radius2 - a.radius2) / (b.z - a.z),
                 second_slope = (c.radius2 - b.radius2) / (c.z - b.z),
                 bend = (second_slope - first_slope) / (c.z - a.z);
    points[i].rate = first_slope + bend * (2.0 * points[i].z - a.z - b.z);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    add_smooth(walls, points[i], points[i + 1], "side" + std::to_string(first));
  return last;
}

/// The mesh with its groups in this order, as far as it has them.
TriMesh in_group_order(TriMesh mesh, const std::vector<std::string>& order) {
  const std::vector<std::string> names = mesh.groups;
  mesh.groups.clear();
  std::vector<std::uint32_t> now(names.size());
  for (const std::string& name : order) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) continue;
    now[static_cast<std::size_t>(found - names.begin())] = static_cast<std::uint32_t>(mesh.groups.size());
    mesh.groups.push_back(name);
  }
  for (std::uint32_t& group : mesh.group) group = now[group];
  return mesh;
}

}  // namespace

double sagitta(double radius, double height, double conic, const std::vector<double>& aspheric) {
  if (radius == 0.0) return 0.0;
  const double u = height * height;
  const double far = std::sqrt(std::max(0.0, radius * radius - (1.0 + conic) * u));
  double depth = u / (std::abs(radius) + far) * (radius > 0.0 ? 1.0 : -1.0), power = u;
  for (const double term : aspheric) depth += term * (power *= u);
  return depth;
}

TriMesh make_lens(const LensShape& shape) {
  const double half = 0.5 * shape.diameter;
  if (!(half > 0.0) || !(shape.thickness > 0.0))
    reject_shape("a lens needs a positive diameter and thickness", "");
  check_sections(shape.segments, "a lens");
  const LensFace bottom{0.0, 1.0, shape.bottom_radius, shape.bottom_conic, shape.bottom_aspheric, "-z"};
  const LensFace top{shape.thickness, -1.0, shape.top_radius, shape.top_conic, shape.top_aspheric, "+z"};
  check_face(bottom, half);
  check_face(top, half);
  const double low = bottom.z(half), high = top.z(half);
  if (high - low < -kOnProfile * shape.diameter)
    reject_shape(
        "the faces of a lens of " + std::to_string(shape.thickness) + " mm thickness cross before its edge",
        "give a thickness of at least " + std::to_string(shape.thickness + low - high) + " mm");
  Profile profile = face_profile(bottom, shape);
  Profile upper = face_profile(top, shape);
  if (high - low > kOnProfile * shape.diameter) {
    profile.sides.back() = {"side", SupportSurface::cylinder(core::Vec3::Zero(), core::Vec3::UnitZ(), half)};
  } else {
    profile.corners.pop_back();
    profile.sides.pop_back();
  }
  // Backwards, from the edge to the axis; the last side is on the axis.
  std::reverse(upper.corners.begin(), upper.corners.end());
  std::reverse(upper.sides.begin(), upper.sides.end() - 1);
  for (std::size_t i = 0; i < upper.corners.size(); ++i) {
    profile.corners.push_back(upper.corners[i]);
    profile.sides.push_back(upper.sides[i]);
  }
  return in_group_order(revolve(profile, shape.segments), {"-z", "+z", "side"});
}

TriMesh make_revolved(const std::vector<std::array<double, 2>>& profile, int segments,
                      const std::vector<std::array<std::size_t, 2>>& smooth) {
  check_sections(segments, "a body of revolution");
  double size = 0.0;
  for (const auto& [r, z] : profile) size = std::max(size, std::hypot(r, z));
  Profile walls;
  const auto group = [](std::size_t side) { return "side" + std::to_string(side); };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto range = std::find_if(smooth.begin(), smooth.end(), [&](const auto& s) { return s[0] == i; });
    if (range != smooth.end()) {
      i = add_smooth_range(walls, profile, *range) - 1;
      continue;
    }
    const Eigen::Vector2d from(profile[i][0], profile[i][1]);
    const std::size_t next = (i + 1) % profile.size();
    const Eigen::Vector2d to(profile[next][0], profile[next][1]);
    const bool on_axis = from.x() <= kOnProfile * size && to.x() <= kOnProfile * size;
    walls.add(from, group(i), on_axis ? std::nullopt : straight_wall(from, to, kOnProfile * size));
  }
  return revolve(walls, segments);
}

TriMesh make_tube(const TubeShape& shape) {
  check_sections(shape.segments, "a tube");
  if (!(shape.inner_radius > 0.0) || !(shape.outer_radius > shape.inner_radius) || !(shape.height > 0.0))
    reject_shape("a tube needs a positive height and inner radius, and an outer radius above that", "");
  const core::Vec3 z = core::Vec3::UnitZ();
  Profile profile;
  profile.add({shape.inner_radius, 0.0}, "-z");
  profile.add({shape.outer_radius, 0.0}, "side",
              SupportSurface::cylinder(core::Vec3::Zero(), z, shape.outer_radius));
  profile.add({shape.outer_radius, shape.height}, "+z");
  profile.add({shape.inner_radius, shape.height}, "bore",
              SupportSurface::cylinder(core::Vec3::Zero(), z, shape.inner_radius));
  return revolve(profile, shape.segments);
}

TriMesh make_torus(const TorusShape& shape) {
  check_sections(std::min(shape.segments, shape.tube_segments), "a torus");
  if (!(shape.tube_radius > 0.0) || !(shape.radius > shape.tube_radius))
    reject_shape("a torus needs a positive tube_radius, and a radius above it",
                 "radius is that of the circle in the middle of the tube");
  Profile profile;
  const SupportSurface surface =
      SupportSurface::torus(core::Vec3::Zero(), core::Vec3::UnitZ(), shape.radius, shape.tube_radius);
  for (int i = 0; i < shape.tube_segments; ++i) {
    const double angle = core::kTwoPi * i / shape.tube_segments;
    profile.add({shape.radius + shape.tube_radius * std::cos(angle), shape.tube_radius * std::sin(angle)},
                "torus", surface);
  }
  return revolve(profile, shape.segments);
}

}  // namespace scintray::mesh
