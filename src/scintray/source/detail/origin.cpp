#include "scintray/source/detail/origin.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

Origin::Origin(const std::variant<scene_file::RegionSpec, core::Vec3>& spec, const scene::Scene& scene) {
  if (const auto* region = std::get_if<scene_file::RegionSpec>(&spec)) {
    add_parts(*region, scene);
  } else {
    const core::Vec3& point = std::get<core::Vec3>(spec);
    point_ = true;
    boxes_.push_back({scene.locate(point), Eigen::AlignedBox3d(point, point)});
  }
  double volume = 0.0;
  for (Box& box : boxes_) box.most = volume += box.box.volume();
  for (Box& box : boxes_) box.most /= std::max(volume, 1e-300);
  if (!point_) {
    for (Box& box : boxes_) box.inside = scene.region_contains(box.region, box.box);
    core::Rng rng(0, core::StreamKind::other,
                  0);  // throws before the run for an empty region
    sample(scene, rng);
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
  if (boxes_.empty())
    throw core::InputError({spec.where, "the source region lies outside part \"" + spec.part.name + "\"",
                            "\"" + last->name +
                                "\" extends from z = " + std::to_string(last->bounds.min().z()) + " mm to " +
                                std::to_string(last->bounds.max().z()) + " mm"});
}

void Origin::add_box(const scene_file::RegionSpec& spec, const scene::PartInfo& part) {
  core::Vec3 low = part.bounds.min(), high = part.bounds.max();
  if (spec.slab_z_mm) {
    low.z() = std::max(low.z(), (*spec.slab_z_mm)[0]);
    high.z() = std::min(high.z(), (*spec.slab_z_mm)[1]);
  }
  if (spec.box) {
    low = low.cwiseMax(spec.box->low);
    high = high.cwiseMin(spec.box->high);
  }
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
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    const core::Vec3 position = box.box.min() + box.box.sizes().cwiseProduct(core::Vec3(x, y, z));
    if (box.inside || scene.region_contains(box.region, position)) return {position, box.region};
  }
  throw core::InputError(core::Problem{
      {},
      "no point of the source region lies inside \"" + scene.region_names[boxes_.front().region] + "\"",
      "check slab_z or box against the part's position (scintray check prints it)"});
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
