#include "scintray/simulation/run_names.hpp"

namespace scintray::simulation {

namespace {

template <typename IdType, typename Count>
core::IdVector<IdType, Count> moved(const core::IdVector<IdType, Count>& counts,
                                    const core::IdVector<IdType, IdType>& to, std::size_t size) {
  core::IdVector<IdType, Count> result(size);
  for (const IdType id : counts.ids()) result[to[id]] += counts[id];
  return result;
}

/// The same of sums over events. Squares of a sum do not follow from those of its parts: two of one name are
/// not known.
template <typename IdType>
core::IdVector<IdType, tally::EventShare> moved_events(
    const core::IdVector<IdType, tally::EventShare>& events, const core::IdVector<IdType, IdType>& to,
    std::size_t size) {
  core::IdVector<IdType, tally::EventShare> result(size);
  core::IdVector<IdType, int> count(size);
  for (const IdType id : events.ids()) {
    if (events[id].squares == 0) continue;
    result[to[id]] = ++count[to[id]] == 1 ? events[id] : tally::EventShare();
  }
  return result;
}

}  // namespace

void RunNames::add(const scene::Scene& scene) {
  for (const scene::SceneMedium& medium : scene.media) media.add(medium.medium().name);
  for (const optics::Surface& surface : scene.surfaces) surfaces.add(surface.name);
  for (const scene::PartInfo& part : scene.parts) parts.add(part.name);
  for (const scene::FaceInfo& face : scene.faces) faces.add(face.name);
}

Renumbering::Renumbering(const scene::Scene& scene, const RunNames& names)
    : media_count_(names.media.names().size()), surface_count_(names.surfaces.names().size()) {
  for (const scene::SceneMedium& medium : scene.media) media_.push_back(names.media.id(medium.medium().name));
  for (const optics::Surface& surface : scene.surfaces) surfaces_.push_back(names.surfaces.id(surface.name));
  for (const scene::PartInfo& part : scene.parts) parts_.push_back(names.parts.id(part.name));
  for (const scene::FaceInfo& face : scene.faces) faces_.push_back(names.faces.id(face.name));
}

tally::PointSums Renumbering::applied(tally::PointSums sums) const {
  tally::PointResult& counts = sums.counts;
  counts.absorbed_in_medium = moved(counts.absorbed_in_medium, media_, media_count_);
  counts.absorbed_at_surface = moved(counts.absorbed_at_surface, surfaces_, surface_count_);
  counts.events_in_medium = moved_events(counts.events_in_medium, media_, media_count_);
  counts.events_at_surface = moved_events(counts.events_at_surface, surfaces_, surface_count_);
  sums.shifted_in_medium = moved(sums.shifted_in_medium, media_, media_count_);
  sums.shifted_at_surface = moved(sums.shifted_at_surface, surfaces_, surface_count_);
  for (tally::SensorFaceCount& count : counts.sensor_faces) {
    count.part = parts_[count.part];
    count.face = faces_[count.face];
  }
  return sums;
}

std::vector<tally::ReadoutChannel> Renumbering::applied(std::vector<tally::ReadoutChannel> channels) const {
  for (tally::ReadoutChannel& channel : channels) {
    channel.part = parts_[channel.part];
    if (channel.face.has_value()) channel.face = faces_[channel.face];
  }
  return channels;
}

std::vector<tally::EventRecord> Renumbering::applied(std::vector<tally::EventRecord> events) const {
  for (tally::EventRecord& event : events)
    if (event.part.has_value()) event.part = parts_[event.part];
  return events;
}

std::vector<tally::DetectedPhoton> Renumbering::applied(std::vector<tally::DetectedPhoton> photons) const {
  for (tally::DetectedPhoton& photon : photons) {
    photon.part = parts_[photon.part];
    photon.face = faces_[photon.face];
  }
  return photons;
}

}  // namespace scintray::simulation
