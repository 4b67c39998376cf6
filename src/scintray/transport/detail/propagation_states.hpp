#pragma once
/// States of a photon that propagates through a region, for each kind of ray query.

#include <vector>

#include "scintray/core/lanes.hpp"
#include "scintray/scene/accelerator.hpp"
#include "scintray/transport/detail/box_reflections.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"
#include "scintray/transport/detail/step_parts.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

static_assert(kTimePerLength_ns_per_mm == 1.0 / core::kSpeedOfLight_mm_per_ns);

/// Straight propagation of the photon by a distance. Time advances with the group velocity.
inline void advance(source::Photon& photon, double distance_mm) {
  photon.position += distance_mm * photon.ray.direction;
  photon.path_mm += distance_mm;
  photon.time_ns += time_along(distance_mm, photon.optics.group_index);
}

/// Sum of three vectors times the first three numbers of v; the fourth number of v is kept.
inline core::Lanes combine(core::Lanes v, core::Lanes x, core::Lanes y, core::Lanes z) {
  return (v.xy[0] * x + v.xy[1] * y + v.zw[0] * z).with_fourth(v.zw[1]);
}
inline core::Lanes rotate(const core::PlainMatrix3& m, core::Lanes v) {
  return combine(v, {m.column(0), 0.0}, {m.column(1), 0.0}, {m.column(2), 0.0});
}
inline core::Lanes rotate_back(const core::PlainMatrix3& m, core::Lanes v) {
  return combine(v, {m.row(0), 0.0}, {m.row(1), 0.0}, {m.row(2), 0.0});
}

/// The point at which a ray leaves its region.
struct Wall {
  std::uint32_t triangle = scene::kNoTriangle;
  double distance_mm = 0.0;
  bool resolved = false;  ///< by the exact query
};

/// The step of a total reflection at this boundary of the photon's region.
inline Step total_reflection(const scene::Scene& scene, const source::Photon& photon, std::uint32_t triangle,
                             double cosine) {
  const scene::BoundaryLink& link = scene.link(scene.regions[photon.region], triangle);
  Step step;
  step.event = core::StepEvent::reflected;
  step.from_back = link.from_back;
  step.region = photon.region;
  step.interface = link.interface;
  step.triangle = triangle;
  step.cos_before = step.cos_after = cosine;
  return step;
}

/// A photon that is propagated in place, for any ray query. Faster than EmbreePropagation without Embree, and
/// up to the first total reflection, which is the whole propagation at rough faces.
class StoredPropagation {
 public:
  static constexpr bool kUnfolds = false;

  StoredPropagation(const scene::Scene& scene, const scene::Region& region, source::Photon& photon)
      : region_(region), accelerator_(scene.accelerator(region)), photon_(photon) {}

  Wall next_wall() const {
    const core::Vec3 origin = region_.point_to_local(photon_.position);
    const core::Vec3 direction = region_.direction_to_local(photon_.ray.direction);
    scene::Exit exit;
    if (photon_.on_triangle != scene::kNoTriangle)
      exit = accelerator_.exit_across_gap(origin, direction, photon_.on_triangle);
    if (exit.triangle == scene::kNoTriangle) exit = accelerator_.find_exit(origin, direction);
    return {exit.triangle, exit.distance_mm, exit.resolved};
  }
  double depth_left() const { return photon_.optical_depth; }
  void move(double distance_mm, double depth) {
    photon_.optical_depth -= depth;
    advance(photon_, distance_mm);
  }
  /// Cosine of incidence at the wall.
  double incidence(const Wall& wall) {
    normal_ = region_.direction_to_world(accelerator_.normal(wall.triangle));
    return photon_.ray.direction.dot(normal_);
  }
  void reflect_at(const Wall& wall, double) {
    ++photon_.interactions;
    optics::reflect(photon_.ray, normal_);
    if (region_.thin_gaps) photon_.on_triangle = wall.triangle;
  }
  bool allowed_by(const PropagationLimits& limits) const {
    return limits.allow(photon_.interactions, photon_.time_ns);
  }
  bool goes_on() const { return !accelerator_.uses_embree(); }
  void turn() const {}
  void store(source::Photon&) const {}

 private:
  const scene::Region& region_;
  const scene::Accelerator& accelerator_;
  source::Photon& photon_;
  core::Vec3 normal_;
};

/// A photon in a region that unfolds: before each segment, total reflections are passed many at once.
class UnfoldedPropagation : public StoredPropagation {
 public:
  static constexpr bool kUnfolds = true;

  UnfoldedPropagation(const scene::Scene& scene, const scene::Region& region, source::Photon& photon)
      : StoredPropagation(scene, region, photon),
        scene_(scene),
        region_(region),
        photon_(photon),
        attenuation_per_mm_(photon.optics.absorption_per_mm + photon.optics.scattering_per_mm) {
    const std::vector<scene::BoundingPlane>& planes = scene.accelerator(region).boundary().planes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const scene::BoundingPlane &first = planes[2 * axis], &second = planes[2 * axis + 1];
      faces_[axis] = {first.offset, second.offset, 1.0 / (first.offset + second.offset), least_sin2(first),
                      least_sin2(second)};
    }
  }

  /// Passes total reflections up to shortly before the next other event. @return their number
  std::uint32_t pass_reflections(const PropagationLimits& limits) {
    const core::Vec3 from = region_.point_to_local(photon_.position);
    const double time_per_mm = time_along(1.0, photon_.optics.group_index);
    const BoxReflections<double> passed(
        faces_, triple(from),
        {triple(region_.direction_to_local(photon_.ray.direction)),
         triple(region_.direction_to_local(photon_.ray.polarisation))},
        {photon_.optical_depth, attenuation_per_mm_, limits.time_ns - photon_.time_ns, time_per_mm,
         static_cast<double>(limits.interactions) - static_cast<double>(photon_.interactions)});
    const auto count = static_cast<std::uint32_t>(passed.count);
    if (count == 0) return 0;
    if (limits.passed) [[unlikely]]
      show(count, limits);
    // Without a rotation from the world's own coordinates, as the lanes do.
    photon_.position =
        region_.rotated
            ? core::Vec3(region_.centre + region_.direction_to_world(vec(passed.position(triple(from), {}))))
            : vec(passed.position(triple(photon_.position), triple(region_.centre)));
    const optics::LightRay<double> light = passed.light();
    photon_.ray.direction = region_.direction_to_world(vec(light.direction));
    photon_.ray.polarisation = region_.direction_to_world(vec(light.polarisation));
    const double path_mm = passed.path_mm;
    photon_.path_mm += path_mm;
    photon_.time_ns += path_mm * time_per_mm;
    photon_.optical_depth -= attenuation_per_mm_ * path_mm;
    photon_.interactions += count;
    return count;
  }

 private:
  static core::Triple<double> triple(const core::PlainVec3& v) { return {v.x(), v.y(), v.z()}; }
  static core::Vec3 vec(const core::Triple<double>& v) { return {v.x, v.y, v.z}; }

  double least_sin2(const scene::BoundingPlane& plane) {
    const bool leads_to_several = plane.triangles_begin != plane.triangles_end;
    const scene::TotalReflection at = leads_to_several
                                          ? scene::TotalReflection()
                                          : scene_.total_reflection(scene_.link(region_, plane.first));
    if (at != last_) {
      last_ = at;
      last_sin2_ = scene::least_sin2(scene_, at, photon_.optics.index, photon_.wavelength_nm);
    }
    return last_sin2_;
  }
  /// Shows the next total reflections, of another photon that passes one after another.
  void show(std::uint32_t count, const PropagationLimits& limits) const {
    source::Photon photon = photon_;
    StoredPropagation state(scene_, region_, photon);
    for (; count > 0; --count) {
      const Wall wall = state.next_wall();
      state.move(wall.distance_mm, attenuation_per_mm_ * wall.distance_mm);
      const double cosine = state.incidence(wall);
      state.reflect_at(wall, cosine);
      limits.passed(photon, total_reflection(scene_, photon, wall.triangle, cosine));
    }
  }

  const scene::Scene& scene_;
  const scene::Region& region_;
  source::Photon& photon_;
  double attenuation_per_mm_;
  BoxAxis<double>::Faces faces_[3];
  scene::TotalReflection last_;
  double last_sin2_ = scene::kNeverTotal;
};

/// A photon in a region with exact round faces. At each face its position is moved onto the face, and the
/// face of reflection is known in the next ray query, so that rounding errors do not accumulate over grazing
/// reflections around a wall.
class CurvedPropagation {
 public:
  static constexpr bool kUnfolds = false;

  CurvedPropagation(const scene::Scene& scene, const scene::Region& region, source::Photon& photon)
      : region_(region), accelerator_(scene.accelerator(region)), photon_(photon) {}

  Wall next_wall() {
    const scene::Exit exit =
        accelerator_.find_exact_exit(region_.point_to_local(photon_.position),
                                     region_.direction_to_local(photon_.ray.direction), photon_.on_triangle);
    next_ = exit.triangle;
    return {exit.triangle, exit.distance_mm, exit.resolved};
  }
  double depth_left() const { return photon_.optical_depth; }
  /// To the last wall.
  void move(double distance_mm, double depth) {
    photon_.optical_depth -= depth;
    advance(photon_, distance_mm);
    photon_.on_triangle = next_;
    const mesh::Foot wall = accelerator_.nearest_at(next_, region_.point_to_local(photon_.position));
    photon_.position += region_.direction_to_world(wall.step);
    normal_ = region_.direction_to_world(wall.normal);
  }
  /// Cosine of incidence at the wall.
  double incidence(const Wall&) { return photon_.ray.direction.dot(normal_); }
  void reflect_at(const Wall&, double) {
    ++photon_.interactions;
    optics::reflect(photon_.ray, normal_);
  }
  bool allowed_by(const PropagationLimits& limits) const {
    return limits.allow(photon_.interactions, photon_.time_ns);
  }
  static bool goes_on() { return true; }
  void turn() const {}
  void store(source::Photon&) const {}

 private:
  const scene::Region& region_;
  const scene::Accelerator& accelerator_;
  source::Photon& photon_;
  core::Vec3 normal_;
  std::uint32_t next_ = scene::kNoTriangle;  ///< of the last wall
};

/// A photon between Embree's walls, in registers. The latency is that of Embree and then of the numbers of
/// the next ray, so the next ray starts from Embree's own hit, in single precision, while the exact one is
/// computed beside it; every segment starts again from exact numbers. No address of a member that changes may
/// be taken, which would place it in memory. tools/bench --scene polished_embree measures the gain.
class EmbreePropagation {
 public:
  static constexpr bool kUnfolds = false;

  EmbreePropagation(const scene::Scene& scene, const scene::Region& region, const source::Photon& photon)
      : region_(region),
        accelerator_(scene.accelerator(region)),
        rotated_(region.rotated),
        start_mm_(accelerator_.start_mm()),
        rates_{1.0, photon.optics.group_index * kTimePerLength_ns_per_mm},
        centre_(region.centre, 1.0),
        position_(photon.position, 0.0),
        direction_(photon.ray.direction, 0.0),
        polarisation_(photon.ray.polarisation, 0.0),
        path_and_time_{photon.path_mm, photon.time_ns},
        depth_left_(photon.optical_depth),
        interactions_(photon.interactions),
        local_(to_local(position_ - centre_)),
        ahead_(to_local(direction_)),
        ray_origin_(local_.with_fourth(start_mm_).floats()),
        ray_direction_(ahead_.floats()) {}

  Wall next_wall() {
    const scene::FirstHit hit = accelerator_.first_hit(ray_origin_, ray_direction_);
    scene::Approach approach;
    if (hit.triangle != scene::kNoTriangle) [[likely]]
      approach = accelerator_.approach_of(hit.triangle, local_, ahead_);
    hit_mm_ = hit.distance_mm;
    cosine_ = approach.cosine;
    sure_ = approach.cosine > 0.0;
    if (sure_) [[likely]]
      return {hit.triangle, approach.distance_mm, false};
    const scene::Exit exit = accelerator_.exact_exit(local_.vec(), ahead_.vec(), hit);
    if (exit.triangle != scene::kNoTriangle) cosine_ = dot(accelerator_.plane(exit.triangle), ahead_);
    return {exit.triangle, exit.distance_mm, exit.resolved};
  }
  double depth_left() const { return depth_left_; }
  void move(double distance_mm, double depth) {
    depth_left_ -= depth;
    path_and_time_ += distance_mm * rates_;
    position_ = position_ + distance_mm * direction_;
  }
  double incidence(const Wall&) const { return cosine_; }
  /// As optics::reflect().
  void reflect_at(const Wall& wall, double cosine) {
    ++interactions_;
    core::Lanes normal = accelerator_.plane(wall.triangle).with_fourth(0.0);
    if (rotated_) normal = rotate(region_.rotation, normal);
    const core::Lanes twice = normal + normal;
    direction_ = direction_ - cosine * twice;
    polarisation_ = dot(normal, polarisation_) * twice - polarisation_;
  }
  bool allowed_by(const PropagationLimits& limits) const {
    return limits.allow(interactions_, path_and_time_[1]);
  }
  static bool goes_on() { return true; }
  /// Prepares the next ray.
  void turn() {
    ray_origin_ = local_.with_fourth(start_mm_).floats() + hit_mm_ * ray_direction_;
    local_ = to_local(position_ - centre_);
    ahead_ = to_local(direction_);
    ray_direction_ = ahead_.floats();
    if (!sure_) [[unlikely]]
      ray_origin_ = local_.with_fourth(start_mm_).floats();
  }
  void store(source::Photon& photon) const {
    photon.position = position_.vec();
    photon.ray.direction = direction_.vec();
    photon.ray.polarisation = polarisation_.vec();
    photon.path_mm = path_and_time_[0];
    photon.time_ns = path_and_time_[1];
    photon.optical_depth = depth_left_;
    photon.interactions = static_cast<std::uint32_t>(interactions_);
  }

 private:
  core::Lanes to_local(core::Lanes v) const { return rotated_ ? rotate_back(region_.rotation, v) : v; }

  const scene::Region& region_;
  const scene::Accelerator& accelerator_;
  const bool rotated_;
  const double start_mm_;
  const core::TwoDoubles rates_;  ///< of path and time
  const core::Lanes centre_;

  core::Lanes position_, direction_, polarisation_;
  core::TwoDoubles path_and_time_;
  double depth_left_;
  std::uint64_t interactions_;
  core::Lanes local_, ahead_;  ///< in the region's frame, in the accelerator's form: fourth -1 and 0
  core::FourFloats ray_origin_, ray_direction_;
  float hit_mm_ = 0.0f;  ///< Embree's, along the ray
  double cosine_ = 0.0;
  bool sure_ = true;  ///< the last wall is Embree's own
};

}  // namespace scintray::transport
