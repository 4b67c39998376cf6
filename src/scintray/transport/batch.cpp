#include "scintray/transport/batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/detail/step_parts.hpp"
#include "scintray/transport/lane_width.hpp"

namespace scintray::transport {

namespace {

using Triple = LanePool::Numbers[3];

void put(const core::PlainVec3& from, Triple& to, std::size_t index) {
  for (int axis = 0; axis < 3; ++axis) to[axis][index] = from[axis];
}
core::PlainVec3 vec(const Triple& from, std::size_t index) {
  return {from[0][index], from[1][index], from[2][index]};
}

/// State of a random stream.
struct StreamState {
  std::array<std::uint64_t, 4> counter;
  std::array<std::uint64_t, 2> key;
  std::array<std::uint64_t, 4> buffer;
  std::int64_t used;
};
static_assert(sizeof(StreamState) == sizeof(core::Rng));

/// A region without planes, for lanes that have no photon yet.
LaneRegion empty_region() {
  static const LanePlanes planes{};
  static const LaneFace faces[2] = {};
  return {&planes, faces, 1};
}

}  // namespace

Batch::Batch(const scene::Scene& scene, const PropagationLimits& limits, int lane_width)
    : scene_(scene), limits_(limits), run_lanes_(run_lanes(lane_width)), lane_scene_(scene), pool_{} {
  const std::vector<int>& widths = lane_widths();
  if (std::find(widths.begin(), widths.end(), lane_width) == widths.end())
    throw core::InternalError("this processor has no lanes of width " + std::to_string(lane_width));
  for (LaneRegion& region : pool_.region) region = empty_region();
  pool_.most_interactions = static_cast<double>(limits.interactions);
  pool_.most_time_ns = limits.time_ns;
}

const std::vector<TracedPhoton>& Batch::trace(std::uint64_t count, Stream stream, Emit emit) {
  counts_ = {};
  next_ = 0;
  stream_ = stream;
  emit_ = emit;
  traced_.resize(count);
  travellers_.resize(LanePool::kPhotons);
  for (std::size_t i = 0; i < LanePool::kPhotons; ++i) start_next(i);
  while (some_in_lanes()) {
    run_lanes_(pool_);
    for (std::size_t i = 0; i < LanePool::kPhotons; ++i)
      if (pool_.state[i] >= lane_state::kFirstWaiting) go_on_after_lanes(i);
  }
  return traced_;
}

bool Batch::some_in_lanes() const {
  return std::any_of(std::begin(pool_.state), std::end(pool_.state),
                     [](double state) { return state != lane_state::kEmpty; });
}

/// Starts photons at this index until one is in lanes, or none is left.
void Batch::start_next(std::size_t index) {
  Traveller& traveller = travellers_[index];
  pool_.state[index] = lane_state::kEmpty;
  while (next_ < traced_.size()) {
    traveller.number = next_++;
    traveller.rng = stream_(traveller.number);
    traveller.photon = emit_(traveller.number, traveller.rng);
    traveller.has_numbers = false;
    if (follow(index)) return;
  }
}

/// Traces a photon alone until it is in lanes; false when it ends before.
bool Batch::follow(std::size_t index) {
  Traveller& traveller = travellers_[index];
  while (!run_lanes_ || !scene_.regions[traveller.photon.region].in_lanes)
    if (!goes_on(traveller, step(scene_, traveller.photon, traveller.rng, limits_))) return false;
  enter_lanes(index);
  return true;
}

void Batch::go_on_after_lanes(std::size_t index) {
  Traveller& traveller = travellers_[index];
  const double waiting_as = pool_.state[index];
  leave_lanes(index);
  if (waiting_as == lane_state::kCut) {
    traced_[traveller.number] = {traveller.photon, {}, limits_.reached(traveller.photon)};
    return start_next(index);
  }
  if (!goes_on(traveller, finish_step(waiting_as, index)) || !follow(index)) start_next(index);
}

/// The rest of the step of a photon that left the lanes.
Step Batch::finish_step(double waiting_as, std::size_t index) {
  Traveller& traveller = travellers_[index];
  source::Photon& photon = traveller.photon;
  const scene::Region& region = scene_.regions[photon.region];
  if (waiting_as == lane_state::kUnclear) return step(scene_, photon, traveller.rng, limits_);
  Propagation propagation;
  if (waiting_as == lane_state::kBulk) {
    propagation.end = PropagationEnd::bulk;
    return end_of_step(scene_, propagation, photon, traveller.rng, nullptr);
  }
  const BoundaryPlace at{lane_scene_.triangle(region, static_cast<std::size_t>(pool_.plane[index])),
                         pool_.cos_before[index]};
  Step taken;
  if (waiting_as == lane_state::kBoundary) {
    propagation.end = PropagationEnd::boundary;
    propagation.triangle = at.triangle;
    return end_of_step(scene_, propagation, photon, traveller.rng, nullptr);
  }
  if (waiting_as == lane_state::kCrossed) {
    taken = cross_boundary(scene_, at, photon);
  } else {
    const scene::BoundaryLink& link = scene_.link(region, at.triangle);
    const scene::LinkSurface surface =
        scene::first_surface(scene_.interfaces[link.interface], link.from_back);
    taken = absorb_at_boundary(scene_, at, surface.id, photon);
  }
  taken.segments = 0;  // counted by the lanes
  return taken;
}

void Batch::enter_lanes(std::size_t index) {
  const Traveller& traveller = travellers_[index];
  const source::Photon& photon = traveller.photon;
  pool_.state[index] = lane_state::kPropagate;
  put(photon.position, pool_.position, index);
  put(photon.ray.direction, pool_.direction, index);
  put(photon.ray.polarisation, pool_.polarisation, index);
  put(scene_.regions[photon.region].centre, pool_.centre, index);
  pool_.path_mm[index] = photon.path_mm;
  pool_.time_ns[index] = photon.time_ns;
  pool_.depth_left[index] = photon.optical_depth;
  pool_.interactions[index] = photon.interactions;
  pool_.segments[index] = 0.0;
  pool_.index[index] = photon.optics.index;
  pool_.group_index[index] = photon.optics.group_index;
  pool_.attenuation_per_mm[index] = photon.optics.absorption_per_mm + photon.optics.scattering_per_mm;
  pool_.plane[index] = 0.0;
  pool_.side[index] = 1.0;
  pool_.region[index] = lane_scene_.region_of(photon, index);
  give_numbers(index);
}

void Batch::leave_lanes(std::size_t index) {
  Traveller& traveller = travellers_[index];
  source::Photon& photon = traveller.photon;
  photon.position = vec(pool_.position, index);
  photon.ray.direction = vec(pool_.direction, index);
  photon.ray.polarisation = vec(pool_.polarisation, index);
  photon.path_mm = pool_.path_mm[index];
  photon.time_ns = pool_.time_ns[index];
  photon.optical_depth = pool_.depth_left[index];
  photon.interactions = static_cast<std::uint32_t>(pool_.interactions[index]);
  counts_.segments += static_cast<std::uint64_t>(pool_.segments[index]);
  take_numbers(index);
}

/// Puts the photon's random stream into the pool, which may have it already, ahead of the photon.
void Batch::give_numbers(std::size_t index) {
  Traveller& traveller = travellers_[index];
  const auto stream = std::bit_cast<StreamState>(traveller.rng);
  pool_.drawn[index] = 4 * stream.counter[0] + static_cast<std::uint64_t>(stream.used) - 4;
  if (traveller.has_numbers && stream.counter[0] <= pool_.counter[0][index]) return;
  traveller.has_numbers = true;
  for (std::size_t i = 0; i < 4; ++i) pool_.counter[i][index] = stream.counter[i];
  for (std::size_t i = 0; i < 2; ++i) pool_.key[i][index] = stream.key[i];
  if (stream.used == 4) return;
  std::uint64_t* const numbers = pool_.numbers[index];
  const std::size_t first = 4 * (stream.counter[0] - 1) % LanePool::kNumbers;
  for (std::size_t i = 0; i < 4; ++i) numbers[first + i] = stream.buffer[i];
  if (first > 0) return;
  for (std::size_t i = 0; i < 4; ++i) numbers[LanePool::kNumbers + i] = stream.buffer[i];
}

/// Sets the photon's random stream to where the pool has drawn up to.
void Batch::take_numbers(std::size_t index) {
  auto stream = std::bit_cast<StreamState>(travellers_[index].rng);
  const std::uint64_t drawn = pool_.drawn[index], in_block = drawn % 4;
  stream.counter[0] = (drawn + 3) / 4;
  stream.used = static_cast<std::int64_t>(in_block == 0 ? 4 : in_block);
  const std::size_t first = (drawn - in_block) % LanePool::kNumbers;
  for (std::size_t i = 0; i < 4; ++i) stream.buffer[i] = pool_.numbers[index][first + i];
  travellers_[index].rng = std::bit_cast<core::Rng>(stream);
}

/// True when the photon goes on after the step; else its end is noted.
bool Batch::goes_on(const Traveller& traveller, const Step& taken) {
  TracedPhoton& traced = traced_[traveller.number];
  if (core::is_final(taken.event)) {
    traced = {traveller.photon, taken, std::nullopt};
    return false;
  }
  counts_.segments += taken.segments;
  counts_.resolved += taken.resolved;
  const std::optional<core::Fate> cut = limits_.reached(traveller.photon);
  if (cut) traced = {traveller.photon, taken, cut};
  return !cut;
}

}  // namespace scintray::transport
