#include <algorithm>
#include <cmath>
#include <string>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/mesh/shapes/solids.hpp"

namespace scintray::mesh {

namespace {

/// Distance, relative to the body, within which a corner is on a line or circle of the profile.
constexpr double kOnProfile = 1e-9;

Eigen::Vector2d in_profile(const core::Vec3& vertex) {
  return {std::hypot(vertex.x(), vertex.y()), vertex.z()};
}

double size_of(const TriMesh& mesh) {
  double size = 0.0;
  for (const core::Vec3& vertex : mesh.vertices) size = std::max(size, vertex.norm());
  return size;
}

/// Assigns the triangles whose corners all are on a face: its group, and its support surface, if it has one.
template <class OnFace>
void assign(TriMesh& mesh, const std::string& group, const std::optional<SupportSurface>& surface,
            const OnFace& on_face) {
  const auto number = static_cast<std::uint32_t>(mesh.groups.size());
  mesh.groups.push_back(group);
  const std::uint32_t support = surface ? mesh.support_index(*surface) : kNoSupport;
  mesh.support.resize(mesh.triangles.size(), kNoSupport);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const bool on = std::all_of(corners.begin(), corners.end(),
                                [&](std::uint32_t v) { return on_face(in_profile(mesh.vertices[v])); });
    if (!on) continue;
    mesh.group[t] = number;
    mesh.support[t] = support;
  }
}

void check_sections(int segments, const char* what) {
  if (segments < 3)
    reject_shape(std::string(what) + " of " + std::to_string(segments) + " segments",
                 "give at least 3 segments");
}

/// The sphere of a lens face; nothing for a flat one.
std::optional<SupportSurface> lens_face(double vertex_z, double radius, bool top) {
  if (radius == 0.0) return std::nullopt;
  const double centre = top ? vertex_z - radius : vertex_z + radius;
  return SupportSurface::sphere({0.0, 0.0, centre}, std::abs(radius));
}

/// Corners of a lens face from the axis outwards.
std::vector<Eigen::Vector2d> face_corners(double vertex_z, double radius, bool top, const LensShape& shape) {
  const double half = 0.5 * shape.diameter;
  if (radius == 0.0) return {{0.0, vertex_z}, {half, vertex_z}};
  const double angle = std::asin(std::min(1.0, half / std::abs(radius)));
  const int pieces = std::max(2, static_cast<int>(std::ceil(angle / core::kTwoPi * shape.segments)));
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i <= pieces; ++i) {
    const double at = i == pieces ? half : std::abs(radius) * std::sin(angle * i / pieces);
    corners.emplace_back(at, vertex_z + (top ? -1.0 : 1.0) * sagitta(radius, at));
  }
  return corners;
}

}  // namespace

double sagitta(double radius, double height) {
  if (radius == 0.0) return 0.0;
  const double far = std::sqrt(std::max(0.0, radius * radius - height * height));
  return height * height / (std::abs(radius) + far) * (radius > 0.0 ? 1.0 : -1.0);
}

TriMesh make_lens(const LensShape& shape) {
  const double half = 0.5 * shape.diameter;
  if (!(half > 0.0) || !(shape.thickness > 0.0))
    reject_shape("a lens needs a positive diameter and thickness", "");
  check_sections(shape.segments, "a lens");
  for (const double radius : {shape.bottom_radius, shape.top_radius})
    if (radius != 0.0 && std::abs(radius) < half)
      reject_shape("a lens face with a radius of curvature below half its diameter",
                   "give a radius of half the diameter or more, or leave it out for a flat face");
  const double low = sagitta(shape.bottom_radius, half),
               high = shape.thickness - sagitta(shape.top_radius, half);
  if (high - low < -kOnProfile * shape.diameter)
    reject_shape(
        "the faces of a lens of " + std::to_string(shape.thickness) + " mm thickness cross before its edge",
        "give a thickness of at least " + std::to_string(shape.thickness + low - high) + " mm");
  std::vector<Eigen::Vector2d> outline = face_corners(0.0, shape.bottom_radius, false, shape);
  std::vector<Eigen::Vector2d> top = face_corners(shape.thickness, shape.top_radius, true, shape);
  const bool has_edge = high - low > kOnProfile * shape.diameter;
  if (!has_edge) outline.pop_back();
  outline.insert(outline.end(), top.rbegin(), top.rend());
  TriMesh mesh = revolved(outline, {.segments = shape.segments});
  mesh.groups.clear();
  const double near = kOnProfile * size_of(mesh);
  const auto on_face = [&](double vertex_z, double radius, bool up) {
    return [=](const Eigen::Vector2d& at) {
      if (at.x() > half + near) return false;
      const double z = vertex_z + (up ? -1.0 : 1.0) * sagitta(radius, std::min(at.x(), half));
      return std::abs(at.y() - z) <= near;
    };
  };
  assign(mesh, "-z", lens_face(0.0, shape.bottom_radius, false), on_face(0.0, shape.bottom_radius, false));
  assign(mesh, "+z", lens_face(shape.thickness, shape.top_radius, true),
         on_face(shape.thickness, shape.top_radius, true));
  if (has_edge)
    assign(mesh, "side", SupportSurface::cylinder(core::Vec3::Zero(), core::Vec3::UnitZ(), half),
           [&](const Eigen::Vector2d& at) { return std::abs(at.x() - half) <= near; });
  return mesh;
}

TriMesh make_revolved(const std::vector<std::array<double, 2>>& profile, int segments) {
  check_sections(segments, "a body of revolution");
  std::vector<Eigen::Vector2d> outline;
  for (const auto& [r, z] : profile) outline.emplace_back(r, z);
  TriMesh mesh = revolved(outline, {.segments = segments});
  if (mesh.triangles.empty() || !(mesh.volume() > 0.0) || !mesh_problems(diagnose(mesh), "it").empty())
    reject_shape("a profile that crosses itself, or holds no volume",
                 "give its corners in order along its edge, the first and the last on the axis (r = 0)");
  mesh.groups.clear();
  const double near = kOnProfile * size_of(mesh);
  for (std::size_t side = 0; side < outline.size(); ++side) {
    const Eigen::Vector2d from = outline[side], to = outline[(side + 1) % outline.size()];
    const double length = (to - from).norm();
    if (length <= near || (from.x() <= near && to.x() <= near)) continue;
    std::optional<SupportSurface> surface;
    const double rise = to.y() - from.y();
    if (std::abs(to.x() - from.x()) <= near)
      surface = SupportSurface::cylinder(core::Vec3::Zero(), core::Vec3::UnitZ(), from.x());
    else if (std::abs(rise) > near) {
      // From the wider end, whose radius is above zero.
      const Eigen::Vector2d wide = from.x() > to.x() ? from : to, narrow = from.x() > to.x() ? to : from;
      const double up = narrow.y() > wide.y() ? 1.0 : -1.0;
      surface =
          SupportSurface::cone({0.0, 0.0, wide.y()}, {0.0, 0.0, up}, wide.x(), narrow.x(), std::abs(rise));
    }
    const Eigen::Vector2d along = (to - from) / length;
    assign(mesh, "side" + std::to_string(side), surface, [&](const Eigen::Vector2d& at) {
      const Eigen::Vector2d off = at - from;
      const double t = along.dot(off);
      return t >= -near && t <= length + near && std::abs(along.x() * off.y() - along.y() * off.x()) <= near;
    });
  }
  if (mesh.supports.empty()) mesh.support.clear();
  return mesh;
}

}  // namespace scintray::mesh
