#include "scintray/tally/tally_plan.hpp"

#include <algorithm>

#include "scintray/core/pattern.hpp"

namespace scintray::tally {

namespace {

/// True when total reflections are counted, or change a variable of the tally.
bool needs_reflections(const scene_file::TallySpec& tally) {
  const auto needs = [](const auto& measured) { return measured.variable->direction_before; };
  return std::find(tally.at.begin(), tally.at.end(), core::StepEvent::reflected) != tally.at.end() ||
         std::any_of(tally.axes.begin(), tally.axes.end(), needs) ||
         std::any_of(tally.ranges.begin(), tally.ranges.end(), needs) ||
         (tally.score && tally.score->direction_before);
}

/// Parts in which light starts by the specification; empty: not specified by part.
std::vector<config::NameRef> source_parts(const scene_file::SceneSpec& spec) {
  const std::variant<scene_file::RegionSpec, core::Vec3>* origin = &spec.source.origin;
  if (spec.energy_source) {
    const auto* placed = std::get_if<scene_file::SpectrumSpec>(&spec.energy_source->kind);
    origin = placed ? &placed->origin : nullptr;
  }
  const auto* region = origin ? std::get_if<scene_file::RegionSpec>(origin) : nullptr;
  return region ? std::vector<config::NameRef>{region->part} : std::vector<config::NameRef>{};
}

/// The direction of incidence that counts at the faces of a part.
scene_file::FaceWay way_at(scene_file::FaceWay wanted, const scene::PartInfo& part) {
  if (wanted != scene_file::FaceWay::arriving) return wanted;
  return part.sensor.has_value() ? scene_file::FaceWay::in : scene_file::FaceWay::out;
}

}  // namespace

TallyPlan::TallyPlan(const scene::Scene& scene, const scene_file::SceneSpec& spec)
    : channels(scene), photon_list(spec.run.photon_list) {
  if (spec.run.photon_history) history.emplace(scene);
  bind_ways(scene);
  bind_photon_list(spec);
  bind_readout(spec, scene);
  if (spec.tallies.empty()) return;

  core::IdVector<core::FaceId, std::vector<std::pair<std::uint32_t, scene_file::FaceWay>>> counts_of_face(
      scene.faces.size());
  for (const scene_file::TallySpec& tally : spec.tallies) {
    const auto number = static_cast<std::uint32_t>(counts.size());
    counts.push_back(bind_count(tally, source_parts(spec), scene));
    std::uint32_t events = 0;
    for (const core::StepEvent event : tally.at) {
      events |= 1u << static_cast<unsigned>(event);
      if (tally.faces.empty()) counts_on[static_cast<std::size_t>(event)].push_back(number);
    }
    events_of.push_back(events);
    events_counted |= events;
    for (const core::FaceId face : faces_of(tally, scene))
      counts_of_face[face].emplace_back(number, way_at(tally.way, scene.parts[scene.faces[face].part]));
    follows_reflections = follows_reflections || needs_reflections(tally);
    follows_regions = follows_regions || !counts.back().visited.empty() || !counts.back().not_visited.empty();
  }
  counts_at.resize(scene.interfaces.size());
  const auto bind = [&](std::vector<CountAtFace>& at_crossing, core::FaceId face, scene_file::FaceWay seen) {
    if (!face.has_value()) return;
    for (const auto& [count, wanted] : counts_of_face[face])
      if (wanted == seen || wanted == scene_file::FaceWay::both)
        at_crossing.push_back({count, face, seen == scene_file::FaceWay::in});
  };
  for (const core::InterfaceId id : scene.interfaces.ids()) {
    const scene::Interface& interface = scene.interfaces[id];
    auto& [from_front, from_back] = counts_at[id];
    bind(from_back, interface.back_face, scene_file::FaceWay::out);
    bind(from_back, interface.front_face, scene_file::FaceWay::in);
    bind(from_front, interface.front_face, scene_file::FaceWay::out);
    bind(from_front, interface.back_face, scene_file::FaceWay::in);
  }
}

void TallyPlan::bind_photon_list(const scene_file::SceneSpec& spec) {
  const scene_file::PhotonOutputSpec& list = spec.run.photons;
  list_every = list.every;
  if (list.channels.empty()) return;
  std::vector<std::string> names;
  for (const ReadoutChannel& channel : channels.list) names.push_back(channel.name);
  list_channels.assign(names.size(), false);
  for (const config::NameRef& wanted : list.channels) {
    bool found = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!core::matches_pattern(wanted.name, names[i])) continue;
      list_channels[i] = found = true;
    }
    if (!found) throw core::unknown_name(wanted.where, "readout channel", wanted.name, names);
  }
}

void TallyPlan::bind_readout(const scene_file::SceneSpec& spec, const scene::Scene& scene) {
  if (!spec.readout) return;
  if (!spec.energy_source)
    throw core::InputError({spec.readout->where,
                            "[readout] makes pulses of events, but this is a source of photons",
                            "use an event source (docs/gamma_sources.md), or remove [readout]"});
  for (const ReadoutChannel& channel : channels.list) {
    try {
      readout.emplace_back(scene.sensors[channel.sensor], *spec.readout,
                           detector::SensorFace{channel.width_mm, channel.height_mm});
    } catch (const core::InputError& error) {
      core::Problem problem = error.problems().front();
      problem.where = spec.readout->where;
      problem.what = "sensor \"" + channel.name + "\": " + problem.what;
      throw core::InputError(problem);
    }
  }
}

void TallyPlan::bind_ways(const scene::Scene& scene) {
  sensor_faces.resize(scene.interfaces.size());
  for (const core::InterfaceId id : scene.interfaces.ids()) {
    const scene::Interface& interface = scene.interfaces[id];
    for (const bool from_back : {false, true}) {
      const core::SensorId sensor = from_back ? interface.front_sensor : interface.back_sensor;
      if (!sensor.has_value()) continue;
      const core::PartId part = from_back ? interface.front_sensor_part : interface.back_sensor_part;
      const core::FaceId own = from_back ? interface.front_face : interface.back_face;
      const core::FaceId face = own.has_value() ? own
                                : from_back     ? interface.back_face
                                                : interface.front_face;
      const auto [known, is_new] =
          sensor_face_of_.try_emplace({part, face}, SensorFaceId(sensor_face_names.size()));
      if (is_new) sensor_face_names.push_back({part, face, 0, 0});
      sensor_faces[id][from_back] = known->second;
    }
  }
}

}  // namespace scintray::tally
