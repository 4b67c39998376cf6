#include "scintray/transport/detail/surface_lanes.hpp"

#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

using Numbers = LanePool::Numbers[3];

void put(const core::PlainVec3& from, Numbers& to, std::size_t slot) {
  for (int axis = 0; axis < 3; ++axis) to[axis][slot] = from[axis];
}
core::PlainVec3 vec(const Numbers& from, std::size_t slot) {
  return {from[0][slot], from[1][slot], from[2][slot]};
}

/// A region without planes, for lanes that have no photon.
LaneRegion empty_region() {
  static const PlanePair planes{};
  static const LaneFace faces[2] = {};
  return {&planes, faces, 1};
}

}  // namespace

SurfaceLanes::SurfaceLanes(const scene::Scene& scene, const PropagationLimits& limits, RunLanes kernel)
    : scene_(scene), limits_(limits), run_(kernel), lane_scene_(scene), pool_{} {
  for (LaneRegion& region : pool_.region) region = empty_region();
  pool_.most_interactions = static_cast<double>(limits.interactions);
  pool_.most_time_ns = limits.time_ns;
  for (std::uint32_t slot = LanePool::kPhotons; slot-- > 0;) free_.push_back(slot);
}

void SurfaceLanes::enter(std::uint32_t name, const source::Photon& photon, const core::Rng& rng) {
  const std::size_t slot = free_.back();
  free_.pop_back();
  names_[slot] = name;
  pool_.state[slot] = lane_state::kPropagate;
  put(photon.position, pool_.position, slot);
  put(photon.ray.direction, pool_.direction, slot);
  put(photon.ray.polarisation, pool_.polarisation, slot);
  put(scene_.regions[photon.region].centre, pool_.centre, slot);
  pool_.path_mm[slot] = photon.path_mm;
  pool_.time_ns[slot] = photon.time_ns;
  pool_.depth_left[slot] = photon.optical_depth;
  pool_.interactions[slot] = photon.interactions;
  pool_.segments[slot] = 0.0;
  pool_.index[slot] = photon.optics.index;
  pool_.group_index[slot] = photon.optics.group_index;
  pool_.attenuation_per_mm[slot] = photon.optics.absorption_per_mm + photon.optics.scattering_per_mm;
  pool_.plane[slot] = 0.0;
  pool_.side[slot] = 1.0;
  pool_.region[slot] = lane_scene_.region_of(photon, slot);
  give_numbers(slot, rng);
}

const std::vector<SurfaceLanes::Left>& SurfaceLanes::run() {
  run_(pool_);
  left_.clear();
  for (std::uint32_t slot = 0; slot < LanePool::kPhotons; ++slot)
    if (pool_.state[slot] >= lane_state::kFirstWaiting)
      left_.push_back({names_[slot], slot, pool_.state[slot]});
  return left_;
}

Step SurfaceLanes::finish(const Left& left, source::Photon& photon, core::Rng& rng) {
  const std::size_t slot = left.slot;
  photon.position = vec(pool_.position, slot);
  photon.ray.direction = vec(pool_.direction, slot);
  photon.ray.polarisation = vec(pool_.polarisation, slot);
  photon.path_mm = pool_.path_mm[slot];
  photon.time_ns = pool_.time_ns[slot];
  photon.optical_depth = pool_.depth_left[slot];
  photon.interactions = static_cast<std::uint32_t>(pool_.interactions[slot]);
  take_numbers(slot, rng);
  pool_.state[slot] = lane_state::kEmpty;
  free_.push_back(left.slot);
  const auto segments = static_cast<std::uint32_t>(pool_.segments[slot]);
  Step taken = rest_of_step(left, photon, rng);
  taken.segments += segments;
  return taken;
}

Step SurfaceLanes::rest_of_step(const Left& left, source::Photon& photon, core::Rng& rng) const {
  if (left.waiting_as == lane_state::kUnclear) return step(scene_, photon, rng, limits_);
  Step taken = step_at_end(left, photon, rng);
  taken.segments = 0;  // counted by the lanes
  return taken;
}

Step SurfaceLanes::step_at_end(const Left& left, source::Photon& photon, core::Rng& rng) const {
  Propagation propagation;
  if (left.waiting_as == lane_state::kBulk) {
    propagation.end = PropagationEnd::bulk;
    return end_of_step(scene_, propagation, photon, rng, nullptr);
  }
  Step taken;
  taken.event = core::StepEvent::reflected;
  if (left.waiting_as == lane_state::kCut) return taken;
  const scene::Region& region = scene_.regions[photon.region];
  const BoundaryPlace at{lane_scene_.triangle(region, static_cast<std::size_t>(pool_.plane[left.slot])),
                         pool_.cos_before[left.slot]};
  if (left.waiting_as == lane_state::kCrossed) return cross_boundary(scene_, at, photon);
  if (left.waiting_as == lane_state::kAbsorbed) {
    const scene::BoundaryLink& link = scene_.link(region, at.triangle);
    const scene::Interface& interface = scene_.interfaces[link.interface];
    return absorb_at_boundary(scene_, at, scene::first_surface(interface, link.from_back).id, photon);
  }
  propagation.end = PropagationEnd::boundary;
  propagation.triangle = at.triangle;
  return end_of_step(scene_, propagation, photon, rng, nullptr);
}

/// Puts the photon's random stream into the pool.
void SurfaceLanes::give_numbers(std::size_t slot, const core::Rng& rng) {
  const core::Rng::State stream = rng.state();
  pool_.drawn[slot] = 4 * stream.counter[0] + static_cast<std::uint64_t>(stream.used) - core::Rng::kDrawn;
  for (std::size_t i = 0; i < 4; ++i) pool_.counter[i][slot] = stream.counter[i];
  for (std::size_t i = 0; i < 2; ++i) pool_.key[i][slot] = stream.key[i];
  std::uint64_t* const numbers = pool_.numbers[slot];
  for (std::size_t block = static_cast<std::size_t>(stream.used) / 4; block < 2; ++block) {
    const std::size_t first = 4 * (stream.counter[0] + block - 2) % LanePool::kNumbers;
    for (std::size_t i = 0; i < 4; ++i) numbers[first + i] = stream.drawn[4 * block + i];
    if (first > 0) continue;
    for (std::size_t i = 0; i < 4; ++i) numbers[LanePool::kNumbers + i] = stream.drawn[4 * block + i];
  }
}

/// Sets the photon's random stream to where the pool has drawn up to.
void SurfaceLanes::take_numbers(std::size_t slot, core::Rng& rng) const {
  core::Rng::State stream = rng.state();
  const std::uint64_t drawn = pool_.drawn[slot], in_block = drawn % 4;
  stream.counter[0] = (drawn + 3) / 4;
  stream.used = static_cast<int>(in_block == 0 ? 8 : 4 + in_block);  // of the second block
  const std::size_t first = (drawn - in_block) % LanePool::kNumbers;
  for (std::size_t i = 0; i < 4; ++i) stream.drawn[4 + i] = pool_.numbers[slot][first + i];
  rng.go_on_from(stream);
}

}  // namespace scintray::transport
