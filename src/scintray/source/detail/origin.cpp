#include "scintray/source/detail/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scintray/core/pattern.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray::source {

namespace {

/// Number of successive draws outside the part after which its region counts as empty.
constexpr int kMostDraws = 1'000'000;

std::vector<std::string> names_of(const core::IdVector<core::PartId, scene::PartInfo>& parts) {
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const scene::PartInfo& part : parts) names.push_back(part.name);
  return names;
}

core::Vec3 point_in(const Eigen::AlignedBox3d& box, core::Rng& rng) {
  const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
  return box.min() + box.sizes().cwiseProduct(core::Vec3(x, y, z));
}

core::InputError empty_region(const core::FileLocation& where, const scene::Scene& scene,
                              core::RegionId region) {
  return core::InputError(
      core::Problem{where, "no point of the source region lies inside \"" + scene.region_names[region] + "\"",
                    "check slab_z or box against the part's position (scintray check prints it)"});
}

/// The slab and the box of a region; infinite along axes that neither bounds.
Eigen::AlignedBox3d bounds_of(const scene_file::RegionSpec& spec) {
  const core::Vec3 far = core::Vec3::Constant(std::numeric_limits<double>::infinity());
  core::Vec3 low = -far, high = far;
  if (spec.slab_z_mm) {
    low.z() = (*spec.slab_z_mm)[0];
    high.z() = (*spec.slab_z_mm)[1];
  }
  if (spec.box) {
    low = low.cwiseMax(spec.box->low);
    high = high.cwiseMin(spec.box->high);
  }
  return {low, high};
}

std::string corner_text(const core::Vec3& corner) {
  return fmt::format("[\"{:g} mm\", \"{:g} mm\", \"{:g} mm\"]", corner.x(), corner.y(), corner.z());
}

core::InputError region_outside(const scene_file::RegionSpec& spec, const scene::PartInfo& part) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  const Eigen::AlignedBox3d region = bounds_of(spec);
  const core::Vec3 &low = part.bounds.min(), &high = part.bounds.max();
  std::string misses;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (region.min()[axis] > high[axis] || region.max()[axis] < low[axis])
      misses += fmt::format("{} along {} it goes from {:g} to {:g} mm, the part from {:g} to {:g} mm",
                            misses.empty() ? ":" : ";", kAxes[axis], region.min()[axis], region.max()[axis],
                            low[axis], high[axis]);
  if (misses.empty()) misses = ": its slab_z and its box do not overlap";
  return core::InputError(
      {spec.where, "the source region lies outside part \"" + spec.part.name + "\"" + misses,
       "give a region within the part, as " +
           (spec.box ? "box = { low = " + corner_text(low) + ", high = " + corner_text(high) + " }"
                     : fmt::format("slab_z = [\"{:g} mm\", \"{:g} mm\"]", low.z(), high.z()))});
}

/// A box and the triangles of a region's boundary, by number, that may reach into it.
struct Piece {
  core::RegionId region;
  Eigen::AlignedBox3d box;
  std::vector<std::uint32_t> triangles;
};

std::vector<scene::BoundaryTriangle> boundary_of(const scene::Scene& scene, core::RegionId region) {
  std::vector<scene::BoundaryTriangle> triangles;
  const scene::Region& of = scene.regions[region];
  for (std::uint32_t i = 0; i < scene.accelerator(of).size(); ++i) triangles.push_back(scene.triangle(of, i));
  return triangles;
}

/// False when one of the axes separates a triangle and a box (T. Akenine-Moller 2001, "Fast 3D triangle-box
/// overlap testing", J. Graphics Tools 6): those of the box, the normal, and their products with the edges.
bool may_overlap(const scene::BoundaryTriangle& triangle, const Eigen::AlignedBox3d& box) {
  const core::Vec3 centre = box.center(), half = 0.5 * box.sizes();
  const core::Vec3 corner[3] = {triangle[0] - centre, triangle[1] - centre, triangle[2] - centre};
  const double slack = 1e-9 * (half.norm() + corner[0].norm());  // rounding never separates
  const auto separates = [&](const core::Vec3& axis) {
    const double a = axis.dot(corner[0]), b = axis.dot(corner[1]), c = axis.dot(corner[2]);
    const double reach = half.dot(axis.cwiseAbs()) + slack * axis.norm();
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const core::Vec3 edge[3] = {corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]};
  if (separates(edge[0].cross(edge[1]))) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const core::Vec3 unit = core::Vec3::Unit(axis);
    if (separates(unit)) return false;
    for (const core::Vec3& along : edge)
      if (separates(unit.cross(along))) return false;
  }
  return true;
}

/// @param among  triangles that may reach into the box; empty: all
Piece piece_of(core::RegionId region, const Eigen::AlignedBox3d& box,
               const std::vector<scene::BoundaryTriangle>& boundary,
               const std::vector<std::uint32_t>& among) {
  Piece piece{region, box, {}};
  const std::size_t count = among.empty() ? boundary.size() : among.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t triangle = among.empty() ? static_cast<std::uint32_t>(i) : among[i];
    if (may_overlap(boundary[triangle], box)) piece.triangles.push_back(triangle);
  }
  return piece;
}

}  // namespace

Origin::Origin(const std::variant<scene_file::RegionSpec, core::Vec3>& spec, const scene::Scene& scene) {
  if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec)) {
    where_ = region->where;
    add_parts(*region, scene);
  } else {
    const core::Vec3& point = std::get<core::Vec3>(spec);
    point_ = true;
    boxes_.push_back({scene.locate(point), Eigen::AlignedBox3d(point, point)});
  }
  weigh(scene);
  if (!point_) {
    constexpr double kLeastFilled = 0.05;
    if (filled_share(scene) < kLeastFilled) refine(scene);
    core::Rng rng(0, core::StreamKind::other,
                  0);  // throws before the run for an empty region
    sample(scene, rng);
  }
}

void Origin::weigh(const scene::Scene& scene) {
  double volume = 0.0;
  for (Box& box : boxes_) box.most = volume += box.box.volume();
  for (Box& box : boxes_) box.most /= std::max(volume, 1e-300);
  if (point_) return;
  for (Box& box : boxes_) box.inside = box.inside || scene.region_contains(box.region, box.box);
}

double Origin::filled_share(const scene::Scene& scene) const {
  constexpr int kPoints = 2000;
  core::Rng rng(0, core::StreamKind::other, 1);
  int filled = 0;
  for (int point = 0; point < kPoints; ++point) {
    const Box& box = sample_box(rng);
    filled += box.inside || scene.region_contains(box.region, point_in(box.box, rng)) ? 1 : 0;
  }
  return static_cast<double>(filled) / kPoints;
}

void Origin::refine(const scene::Scene& scene) {
  constexpr std::size_t kMostPieces = 1 << 16;
  // The largest piece is halved next, so that pieces remain alike. Pieces wholly inside a region stay as they
  // are.
  const auto smaller = [](const Piece& a, const Piece& b) { return a.box.volume() < b.box.volume(); };
  std::vector<Piece> open;
  std::vector<Box> whole;
  const auto add = [&](Piece piece) {
    if (!piece.triangles.empty()) {
      open.push_back(std::move(piece));
      std::push_heap(open.begin(), open.end(), smaller);
    } else if (scene.region_contains(piece.region, core::Vec3(piece.box.center()))) {
      whole.push_back({piece.region, piece.box, true, 1.0});
    }
  };
  std::map<core::RegionId, std::vector<scene::BoundaryTriangle>> boundaries;
  for (const Box& box : boxes_) {
    // The ambient space has no boundary of its own, and fills any box but for the parts.
    if (box.region == scene::kAmbientRegion) return;
    std::vector<scene::BoundaryTriangle>& boundary = boundaries[box.region];
    if (boundary.empty()) boundary = boundary_of(scene, box.region);
    add(piece_of(box.region, box.box, boundary, {}));
  }
  for (std::size_t wanted = 2 * open.size();; wanted *= 2) {
    while (!open.empty() && open.size() < wanted) {
      std::pop_heap(open.begin(), open.end(), smaller);
      const Piece piece = std::move(open.back());
      open.pop_back();
      Eigen::Index axis = 0;
      piece.box.sizes().maxCoeff(&axis);
      Eigen::AlignedBox3d low = piece.box, high = piece.box;
      low.max()[axis] = high.min()[axis] = piece.box.center()[axis];
      for (const Eigen::AlignedBox3d& half : {low, high})
        add(piece_of(piece.region, half, boundaries.at(piece.region), piece.triangles));
    }
    boxes_ = whole;
    for (const Piece& piece : open) boxes_.push_back({piece.region, piece.box, false, 1.0});
    if (boxes_.empty()) throw empty_region(where_, scene, boundaries.begin()->first);
    double volume = 0.0;
    for (Box& box : boxes_) box.most = volume += box.box.volume();
    for (Box& box : boxes_) box.most /= std::max(volume, 1e-300);
    constexpr double kWellFilled = 0.3;
    if (open.empty() || boxes_.size() >= kMostPieces || filled_share(scene) >= kWellFilled) return;
  }
}

void Origin::add_parts(const scene_file::RegionSpec& spec, const scene::Scene& scene) {
  const scene::PartInfo* last = nullptr;
  for (const scene::PartInfo& part : scene.parts) {
    if (!core::matches_pattern(spec.part.name, part.name)) continue;
    last = &part;
    add_box(spec, part);
  }
  if (!last) throw core::unknown_name(spec.part.where, "part", spec.part.name, names_of(scene.parts));
  if (boxes_.empty()) throw region_outside(spec, *last);
}

void Origin::add_box(const scene_file::RegionSpec& spec, const scene::PartInfo& part) {
  const Eigen::AlignedBox3d region = bounds_of(spec);
  const core::Vec3 low = part.bounds.min().cwiseMax(region.min()),
                   high = part.bounds.max().cwiseMin(region.max());
  if ((low.array() <= high.array()).all()) boxes_.push_back({part.region, Eigen::AlignedBox3d(low, high)});
}

std::vector<core::RegionId> Origin::regions() const {
  std::vector<core::RegionId> regions;
  for (const Box& box : boxes_) regions.push_back(box.region);
  return regions;
}

const Origin::Box& Origin::sample_box(core::Rng& rng) const {
  if (boxes_.size() == 1) return boxes_.front();
  const double u = rng.uniform();
  const auto at = std::upper_bound(boxes_.begin(), boxes_.end(), u,
                                   [](double share, const Box& box) { return share < box.most; });
  return at == boxes_.end() ? boxes_.back() : *at;
}

/// A box is drawn by volume, and a point in it; points outside the box's region are rejected, so that
/// accepted points are uniform over the union of the regions.
Place Origin::sample(const scene::Scene& scene, core::Rng& rng) const {
  if (point_) return {boxes_.front().box.min(), boxes_.front().region};
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const Box& box = sample_box(rng);
    const core::Vec3 position = point_in(box.box, rng);
    if (box.inside || scene.region_contains(box.region, position)) return {position, box.region};
  }
  throw empty_region(where_, scene, boxes_.front().region);
}

core::Vec3 sample_direction(const scene_file::DirectionSpec& spec, core::Rng& rng) {
  switch (spec.kind) {
    case scene_file::DirectionKind::isotropic:
      return core::sample_isotropic(rng);
    case scene_file::DirectionKind::beam:
      return spec.axis;
    case scene_file::DirectionKind::lambertian:
      return core::sample_lambertian(spec.axis, rng);
    case scene_file::DirectionKind::cone:
      break;
  }
  const double cosine = 1.0 - rng.uniform() * (1.0 - std::cos(spec.half_angle_rad));
  const double azimuth = core::kTwoPi * rng.uniform();
  return core::turned(spec.axis, cosine, azimuth);
}

}  // namespace scintray::source
