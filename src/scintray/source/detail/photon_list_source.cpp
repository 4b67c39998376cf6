#include "scintray/source/detail/photon_list_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scintray/core/sampling.hpp"
#include "scintray/core/text.hpp"
#include "scintray/source/photon_optics.hpp"

namespace scintray::source {

namespace {

constexpr std::size_t kDescribed = 5;

core::Vec3 vector_at(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                     std::size_t row) {
  return {x[row], y[row], z[row]};
}

/// The order of the rows by their events, and the first row of each event in that order.
struct EventOrder {
  std::vector<std::size_t> rows;
  std::vector<std::size_t> first;
};

EventOrder order_of(const scene_file::PhotonColumns& photons, std::uint64_t photons_per_event) {
  EventOrder order;
  order.rows.resize(photons.x_mm.size());
  std::iota(order.rows.begin(), order.rows.end(), std::size_t{0});
  const auto event_of = [&](std::size_t row) {
    return photons.event.empty() ? static_cast<double>(row / photons_per_event) : photons.event[row];
  };
  std::stable_sort(order.rows.begin(), order.rows.end(),
                   [&](std::size_t a, std::size_t b) { return event_of(a) < event_of(b); });
  for (std::size_t i = 0; i < order.rows.size(); ++i)
    if (i == 0 || event_of(order.rows[i]) != event_of(order.rows[i - 1])) order.first.push_back(i);
  return order;
}

void count(PhotonListReport::Count& counted, const scene_file::PhotonColumns& photons, std::size_t row) {
  ++counted.photons;
  if (counted.first.size() < kDescribed)
    counted.first.push_back(fmt::format("row {} (at {:.6g}, {:.6g}, {:.6g} mm)",
                                        photons.rows.empty() ? row : photons.rows[row], photons.x_mm[row],
                                        photons.y_mm[row], photons.z_mm[row]));
}

std::string first_of(const PhotonListReport::Count& counted) {
  return core::list_of(counted.first) + (counted.photons > counted.first.size() ? ", ..." : "");
}

}  // namespace

PhotonListSource::PhotonListSource(const scene_file::PhotonListSpec& spec, std::uint64_t most,
                                   bool unpolarised, const scene::Scene& scene)
    : origin_(spec.origin()), unpolarised_(unpolarised) {
  const scene_file::PhotonColumns& photons = spec.photons();
  const EventOrder order = order_of(photons, std::max<std::uint64_t>(1, spec.photons_per_event));
  const std::size_t events = most == 0 ? order.first.size() : std::min<std::size_t>(most, order.first.size());
  const std::size_t last = events < order.first.size() ? order.first[events] : order.rows.size();
  photons_.reserve(last);
  for (std::size_t i = 0, event = 0; i < last; ++i) {
    if (event < events && i == order.first[event]) {
      first_.push_back(photons_.size());
      ++event;
    }
    Listed listed;
    if (place(photons, order.rows[i], scene, listed)) photons_.push_back(listed);
  }
  first_.push_back(photons_.size());
  if (report_.opaque.photons > 0 && spec.misplaced == scene_file::Misplaced::refuse)
    throw core::InputError(
        {spec.where,
         fmt::format("{} of {} photons of {} start in a part that absorbs all light: {}",
                     report_.opaque.photons, last, origin_, first_of(report_.opaque)),
         "check length_unit, and that both programs place the parts alike; misplaced = \"leave_out\" counts "
         "such photons in a note and traces the others"});
  if (photons_.empty())
    throw core::InputError(
        {spec.where, fmt::format("all {} photons of {} start in parts that absorb all light", last, origin_),
         "check length_unit, and that both programs place the parts alike"});
  core::IdVector<core::RegionId, bool> used(scene.regions.size(), false);
  for (const Listed& listed : photons_) used[listed.region] = true;
  for (const core::RegionId region : scene.regions.ids())
    if (used[region]) regions_.push_back(region);
}

core::RegionId PhotonListSource::locate(const scene::Scene& scene, const core::Vec3& point) {
  if (latest_ == scene::kAmbientRegion || !scene.region_contains(latest_, point))
    latest_ = scene.locate(point);
  return latest_;
}

bool PhotonListSource::place(const scene_file::PhotonColumns& photons, std::size_t row,
                             const scene::Scene& scene, Listed& listed) {
  const core::Vec3 position = vector_at(photons.x_mm, photons.y_mm, photons.z_mm, row);
  const core::Vec3 direction =
      vector_at(photons.direction_x, photons.direction_y, photons.direction_z, row).normalized();
  const core::Vec3 ahead = position + kBehindFace_mm * direction;
  const core::RegionId here = locate(scene, position);
  listed.region = locate(scene, ahead);
  const bool on_face = here != listed.region;
  if (scene.media[scene.regions[listed.region].medium].is_opaque()) {
    count(report_.opaque, photons, row);
    return false;
  }
  if (on_face)
    count(report_.on_face, photons, row);
  else if (listed.region == scene::kAmbientRegion)
    count(report_.ambient, photons, row);
  listed.position = on_face ? ahead : position;
  listed.direction = direction;
  listed.polarisation = core::Vec3(core::Vec3::Zero());
  if (!photons.polarisation_x.empty()) {
    const core::Vec3 field =
        vector_at(photons.polarisation_x, photons.polarisation_y, photons.polarisation_z, row);
    if (field.norm() > 0.0)
      listed.polarisation = core::Vec3((field - field.dot(direction) * direction).normalized());
    else
      count(report_.polarised_here, photons, row);
  }
  listed.wavelength_nm = photons.wavelength_nm[row];
  listed.time_ns = photons.time_ns.empty() ? 0.0 : photons.time_ns[row];
  return true;
}

void PhotonListSource::begin(const scene::Scene&, std::uint64_t event, core::Rng&, EventLight& light) const {
  light.event = Event();
  light.deposits.clear();
  light.first_listed = first_[event];
  light.photons = first_[event + 1] - first_[event];
}

Photon PhotonListSource::emit(const scene::Scene& scene, const EventLight& light, std::uint64_t number,
                              core::Rng& rng) const {
  const Listed& listed = photons_[light.first_listed + number];
  Photon photon;
  photon.position = listed.position;
  photon.region = listed.region;
  photon.ray.direction = listed.direction;
  photon.ray.polarisation = listed.polarisation;
  if (!unpolarised_ && listed.polarisation.vec().isZero())
    photon.ray.polarisation = core::sample_polarisation(listed.direction, rng);
  photon.wavelength_nm = listed.wavelength_nm;
  photon.time_ns = listed.time_ns;
  photon.optics = scene.optics.at(scene.regions[photon.region].medium, photon.wavelength_nm);
  take_mode(scene, photon, rng);
  photon.optical_depth = core::sample_exponential(rng);
  return photon;
}

std::vector<std::string> PhotonListSource::notes() const {
  std::vector<std::string> notes;
  const std::uint64_t all = photons_.size() + report_.opaque.photons;
  const auto note = [&](const PhotonListReport::Count& counted, const std::string& where) {
    if (counted.photons > 0)
      notes.push_back(fmt::format("{} of {} photons of {} {}: {}", counted.photons, all, origin_, where,
                                  first_of(counted)));
  };
  note(report_.ambient, "start outside every part, in the ambient medium");
  note(report_.on_face, "start on a face, and so one nanometre behind it along their direction");
  note(report_.opaque, "start in a part that absorbs all light, and are left out");
  note(report_.polarised_here, "have a polarisation of zero, and get a random one");
  return notes;
}

}  // namespace scintray::source
