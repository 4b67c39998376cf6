#include "scintray/simulation/run_names.hpp"

namespace scintray::simulation {

namespace {

template <typename Count>
std::vector<Count> moved(const std::vector<Count>& counts, const std::vector<std::uint32_t>& to,
                         std::size_t size) {
  std::vector<Count> result(size);
  for (std::size_t i = 0; i < counts.size(); ++i) result[to[i]] += counts[i];
  return result;
}

}  // namespace

std::uint32_t NameList::add(const std::string& name) {
  const auto [known, is_new] = index_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
  if (is_new) names_.push_back(name);
  return known->second;
}

void RunNames::add(const scene::Scene& scene) {
  for (const scene::SceneMedium& medium : scene.media) media.add(medium.medium().name);
  for (const optics::Surface& surface : scene.surfaces) surfaces.add(surface.name);
  for (const scene::PartInfo& part : scene.parts) parts.add(part.name);
  for (const scene::FaceInfo& face : scene.faces) faces.add(face.name);
}

Renumbering::Renumbering(const scene::Scene& scene, const RunNames& names)
    : media_count_(names.media.names().size()), surface_count_(names.surfaces.names().size()) {
  for (const scene::SceneMedium& medium : scene.media)
    media_.push_back(names.media.index(medium.medium().name));
  for (const optics::Surface& surface : scene.surfaces)
    surfaces_.push_back(names.surfaces.index(surface.name));
  for (const scene::PartInfo& part : scene.parts) parts_.push_back(names.parts.index(part.name));
  for (const scene::FaceInfo& face : scene.faces) faces_.push_back(names.faces.index(face.name));
}

void Renumbering::apply(tally::PointResult& result) const {
  result.absorbed_in_medium = moved(result.absorbed_in_medium, media_, media_count_);
  result.absorbed_at_surface = moved(result.absorbed_at_surface, surfaces_, surface_count_);
  result.shifted_in_medium = moved(result.shifted_in_medium, media_, media_count_);
  result.shifted_at_surface = moved(result.shifted_at_surface, surfaces_, surface_count_);
  for (tally::SensorFaceCount& count : result.sensor_faces) {
    count.part = parts_[count.part];
    count.face = faces_[count.face];
  }
}

std::vector<tally::ReadoutChannel> Renumbering::applied(std::vector<tally::ReadoutChannel> channels) const {
  for (tally::ReadoutChannel& channel : channels) {
    channel.part = parts_[channel.part];
    if (channel.face != scene::kNone)
      channel.face = static_cast<std::int32_t>(faces_[static_cast<std::size_t>(channel.face)]);
  }
  return channels;
}

std::vector<tally::EventRecord> Renumbering::applied(std::vector<tally::EventRecord> events) const {
  for (tally::EventRecord& event : events)
    if (event.part != tally::EventRecord::kNoPart) event.part = parts_[event.part];
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
