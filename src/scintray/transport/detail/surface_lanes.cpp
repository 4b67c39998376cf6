#include <bit>
#include <utility>

#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/detail/photon_numbers.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

/// For lanes that have no photon.
const LaneRecord* empty_optics() {
  static const LaneRecord records[3] = {};
  return records;
}

}  // namespace

SurfaceLanes::SurfaceLanes(const scene::Scene& scene, const LaneScene& lanes, const PropagationLimits& limits,
                           RunLanes kernel)
    : scene_(scene), limits_(limits), run_(kernel), lane_scene_(lanes), own_(LanePool::kPhotons), pool_{} {
  for (LanePhoton& photon : pool_.photons) {
    photon.region = lanes.any_planes();
    photon.optics = empty_optics();
  }
  pool_.most_interactions = static_cast<double>(limits.interactions);
  pool_.most_time_ns = limits.time_ns;
  pool_.one_wavelength = lanes.has_one_wavelength();
  if (pool_.one_wavelength) lanes.set_wavelength(scene.low_nm, at_first_);
  pool_.has_neighbours = lanes.has_neighbours();
  pool_.has_gaps = lane_scene_.has_gaps();
  pool_.unfolds = lane_scene_.unfolds();
  pool_.boxes = lane_scene_.has_boxes_alone();
  pool_.one_box = pool_.boxes && lane_scene_.has_one_shape();
  for (std::uint32_t slot = LanePool::kPhotons; slot-- > 0;) free_.push_back(slot);
}

void SurfaceLanes::enter(std::uint32_t name, const source::Photon& photon, const core::Rng& rng) {
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  names_[slot] = name;
  LanePhoton& entered = pool_.photons[slot];
  give_photon(scene_, photon, entered);
  entered.segments = 0.0;
  entered.index = photon.optics.index;
  entered.side = 1.0;
  entered.region = lane_scene_.region(photon.region);
  entered.optics = optics_at(photon.wavelength_nm, slot);
  const bool at_gap = entered.region.has_gaps != 0;
  entered.plane = at_gap ? *lane_scene_.face_at_gap(scene_.regions[photon.region], photon.on_triangle) : 0.0;
  pool_.in_state[static_cast<std::size_t>(at_gap ? lane_state::kAcross : lane_state::kPropagate)] |=
      std::uint64_t{1} << slot;
  entered.stream[0] = rng.state().first;
  entered.stream[1] = rng.state().second;
}

const LaneRecord* SurfaceLanes::optics_at(double wavelength_nm, std::uint32_t slot) {
  if (at_first_.records.empty()) lane_scene_.set_wavelength(wavelength_nm, at_first_);
  if (at_first_.wavelength_nm == wavelength_nm) return at_first_.records.data();
  LaneScene::AtWavelength& own = own_[slot];
  if (own.wavelength_nm != wavelength_nm) lane_scene_.set_wavelength(wavelength_nm, own);
  return own.records.data();
}

const std::vector<SurfaceLanes::Left>& SurfaceLanes::run() {
  run_(pool_);
  left_.clear();
  for (std::size_t state = lane_state::kFirstOfWaiting; state < lane_state::kCount; ++state) {
    for (std::uint64_t those = std::exchange(pool_.in_state[state], 0); those != 0; those &= those - 1) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(those));
      left_.push_back({names_[slot], slot, static_cast<double>(state),
                       static_cast<std::uint32_t>(pool_.photons[slot].segments)});
    }
  }
  return left_;
}

Step SurfaceLanes::finish(const Left& left, source::Photon& photon, core::Rng& rng) {
  const LanePhoton& from = pool_.photons[left.slot];
  take_photon(from, photon);
  const core::RegionId region(from.region.number);
  if (photon.region != region) {
    photon.region = region;
    photon.optics = scene_.optics.at(scene_.regions[region].medium, photon.wavelength_nm);
  }
  photon.on_triangle = from.region.has_gaps != 0
                           ? lane_scene_.triangle(region, static_cast<std::size_t>(from.plane))
                           : scene::kNoTriangle;
  rng.go_on_from({from.stream[0], from.stream[1]});
  free_.push_back(left.slot);
  return left.waiting_as == lane_state::kUnclear ? step(scene_, photon, rng, limits_)
                                                 : step_at_end(left, photon, rng);
}

Step SurfaceLanes::step_at_end(const Left& left, source::Photon& photon, core::Rng& rng) const {
  Propagation propagation;
  if (left.waiting_as == lane_state::kBulk) {
    propagation.end = PropagationEnd::bulk;
    return end_of_step(scene_, propagation, photon, rng, nullptr);
  }
  if (left.waiting_as == lane_state::kCut) return reflected_in_lanes();
  const BoundaryPlace at{
      lane_scene_.triangle(photon.region, static_cast<std::size_t>(pool_.photons[left.slot].plane)),
      pool_.photons[left.slot].cos_before};
  if (left.waiting_as == lane_state::kCrossed) return cross_boundary(scene_, at, photon);
  if (left.waiting_as == lane_state::kAbsorbed) {
    const scene::BoundaryLink& link = scene_.link(scene_.regions[photon.region], at.triangle);
    return absorb_at_boundary(scene_, at, scene::absorbing_surface(scene_, link), photon);
  }
  propagation.end = PropagationEnd::boundary;
  propagation.triangle = at.triangle;
  return end_of_step(scene_, propagation, photon, rng, nullptr);
}

}  // namespace scintray::transport
