#include "scintray/source/origin.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/pattern.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

/// Draws outside the part in a row after which its region counts as empty.
constexpr int kMostDraws = 1'000'000;

std::vector<std::string> names_of(const std::vector<PartInfo>& parts) {
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const PartInfo& part : parts) names.push_back(part.name);
  return names;
}

}  // namespace

Origin::Origin(const std::variant<RegionSpec, Vec3>& spec, const Scene& scene) {
  if (const auto* region = std::get_if<RegionSpec>(&spec)) {
    add_parts(*region, scene);
  } else {
    const Vec3& point = std::get<Vec3>(spec);
    point_ = true;
    boxes_.push_back({scene.locate(point), Eigen::AlignedBox3d(point, point)});
  }
  double volume = 0.0;
  for (Box& box : boxes_) box.most = volume += box.box.volume();
  for (Box& box : boxes_) box.most /= std::max(volume, 1e-300);
  if (!point_) {
    for (Box& box : boxes_) box.inside = scene.region_contains(box.region, box.box);
    Rng rng(0, StreamKind::other, 0);  // shows now, not in the run, that positions can be found
    sample(scene, rng);
  }
}

void Origin::add_parts(const RegionSpec& spec, const Scene& scene) {
  const PartInfo* last = nullptr;
  for (const PartInfo& part : scene.parts) {
    if (!matches_pattern(spec.part.name, part.name)) continue;
    last = &part;
    add_box(spec, part);
  }
  if (!last) throw unknown_name(spec.part.where, "part", spec.part.name, names_of(scene.parts));
  if (boxes_.empty())
    throw InputError({spec.where, "the source region lies outside part \"" + spec.part.name + "\"",
                      "\"" + last->name + "\" extends from z = " + std::to_string(last->bounds.min().z()) +
                          " mm to " + std::to_string(last->bounds.max().z()) + " mm"});
}

void Origin::add_box(const RegionSpec& spec, const PartInfo& part) {
  Vec3 low = part.bounds.min(), high = part.bounds.max();
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

std::vector<std::uint32_t> Origin::regions() const {
  std::vector<std::uint32_t> regions;
  for (const Box& box : boxes_) regions.push_back(box.region);
  return regions;
}

const Origin::Box& Origin::sample_box(Rng& rng) const {
  if (boxes_.size() == 1) return boxes_.front();
  const double u = rng.uniform();
  const auto at = std::upper_bound(boxes_.begin(), boxes_.end(), u,
                                   [](double share, const Box& box) { return share < box.most; });
  return at == boxes_.end() ? boxes_.back() : *at;
}

/// A box is chosen by its volume and a point in it; points outside the box's region are dropped, so
/// what is kept is uniform over the union of the regions.
Place Origin::sample(const Scene& scene, Rng& rng) const {
  if (point_) return {boxes_.front().box.min(), boxes_.front().region};
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const Box& box = sample_box(rng);
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    const Vec3 position = box.box.min() + box.box.sizes().cwiseProduct(Vec3(x, y, z));
    if (box.inside || scene.region_contains(box.region, position)) return {position, box.region};
  }
  throw InputError(Problem{
      {},
      "no point of the source region lies inside \"" + scene.region_names[boxes_.front().region] + "\"",
      "check slab_z or box against the part's position (scintray check prints it)"});
}

Vec3 sample_direction(const DirectionSpec& spec, Rng& rng) {
  switch (spec.kind) {
    case DirectionKind::isotropic:
      return sample_isotropic(rng);
    case DirectionKind::beam:
      return spec.axis;
    case DirectionKind::lambertian:
      return sample_lambertian(spec.axis, rng);
    case DirectionKind::cone:
      break;
  }
  const double cosine = 1.0 - rng.uniform() * (1.0 - std::cos(spec.half_angle_rad));
  const double azimuth = kTwoPi * rng.uniform();
  return turned(spec.axis, cosine, azimuth);
}

}  // namespace scintray
